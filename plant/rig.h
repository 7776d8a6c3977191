// What a PlantApp runs on: the simulated actuator (simulated_rig.h) or a board in front of a real one.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "model/actuator.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// A fault that a rig reports about itself, with the fields of fault_t.
struct RigFault {
  std::string code;  // docs/faults.md
  std::string text;  // one line: what was found, what is allowed
  double value = std::numeric_limits<double>::quiet_NaN();
  double limit = std::numeric_limits<double>::quiet_NaN();
};

// The rig cannot go on: the run ends with the latched fault code() and exit code 1.
class RigError : public std::runtime_error {
 public:
  RigError(std::string code, const std::string& text) : std::runtime_error(text), code_(std::move(code)) {}
  const std::string& code() const { return code_; }

 private:
  std::string code_;
};

// What the output holds after zero volts were written.
struct OutputLeft {
  bool accepted = true;  // false: the board refused the zero
  double voltage = 0;    // V of eq. (1), read back; NaN: it cannot be read
};

// A rig that samples and puts out by a clock of its own, behind a link. In real time its samples are the
// ticks: each one begins a tick as it arrives, and a command goes out as soon as it is there. It acts from
// the device's next sample on, that is from tick k + 1, and not another tick or two later, as where two
// clocks wait for each other.
class Pacemaker {
 public:
  virtual ~Pacemaker() = default;

  // Takes what has come over the link. Returns the device's number of the newest sample, one more for each
  // tick, if one has come since the last call.
  virtual std::optional<int64_t> Arrived() = 0;

  // Has something to read when something arrives; -1: the link is cut.
  virtual int descriptor() const = 0;

  // Of the voltage that Drive() returned last: the tick of its command; -1: none.
  virtual int64_t acting_command_tick() const = 0;
};

class Rig {
 public:
  virtual ~Rig() = default;

  // The role that it is announced under on the bus: "plant" or "driver".
  virtual std::string role() const = 0;

  // The sensors' readings at `tick`; NaN: not measured, or not credible. Called for tick 0 first, then for
  // increasing ticks. A simulated actuator advances there under the voltage of the last Drive(). Throws
  // RigError.
  virtual model::Measurement Read(int64_t tick) = 0;

  // What is wrong with the last reading. While this is not empty, only zero volts may be driven.
  virtual const std::vector<RigFault>& faults() const = 0;

  // Holds the amplifier voltage (V, of eq. (1)) from now on; it is zero before the first call. Returns the
  // voltage that actually acts, which a limit may have reduced. Throws RigError.
  virtual double Drive(double voltage) = 0;

  // The tick of the command that the voltage of the next Drive() is from; -1: it is zero because something is
  // wrong or nobody commands.
  virtual void Obey(int64_t /*command_tick*/) {}

  // Null: the rig samples when it is read.
  virtual Pacemaker* pacemaker() { return nullptr; }

  // Called often while the run has not begun, and nothing is read or driven.
  virtual void Attend() {}

  // Messages from the machine that were lost on their way, in all.
  virtual int64_t lost_messages() const { return 0; }

  // A simulated rig's sensors have this noise from now on; a real one's have their own.
  virtual void SetNoise(const settings::NoiseSection&) {}
  virtual bool simulated() const { return false; }

  // Puts out zero volts by any means left. May be called at any time, any number of times.
  virtual OutputLeft Zero() noexcept = 0;
  // What a Zero() that has to wait for its device's answer calls meanwhile, once: the others shall hear why
  // no states come before they miss them.
  void set_when_late(std::function<void()> tell) { when_late_ = std::move(tell); }

 protected:
  std::function<void()> when_late_;
};

}  // namespace hydro::plant
