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

// A sensor's fault lasts until so many good readings in a row: a loose contact must not switch the voltage on
// and off at its own pace.
inline constexpr int kGoodReadings = 10;

// Thrown when the rig cannot go on: the run then ends with the latched fault code() and exit code 1.
class RigError : public std::runtime_error {
 public:
  // `value` was found where `limit` is allowed; NaN: the fault is of no number.
  RigError(std::string code, const std::string& text, double value = std::numeric_limits<double>::quiet_NaN(),
           double limit = std::numeric_limits<double>::quiet_NaN())
      : std::runtime_error(text), code_(std::move(code)), value_(value), limit_(limit) {}
  const std::string& code() const { return code_; }
  double value() const { return value_; }
  double limit() const { return limit_; }

 private:
  std::string code_;
  double value_, limit_;
};

// What the output held after zero volts were written.
struct OutputLeft {
  bool accepted = true;  // false: the board refused the zero
  double voltage = 0;    // V of eq. (1), read back; NaN: cannot be read
};

// A rig that samples and puts out voltages by a clock of its own, behind a link. In real time its samples are
// the ticks: each sample begins a tick as it arrives, and a command goes out as soon as it is there. The
// command acts from the device's next sample on, that is from tick k + 1, and not a tick or two later, as it
// would if two clocks waited for each other.
class Pacemaker {
 public:
  virtual ~Pacemaker() = default;

  // Takes everything that has come over the link. If a sample has come since the last call, returns the
  // device's number of the newest one; the number rises by one with each tick.
  virtual std::optional<int64_t> Arrived() = 0;

  // The descriptor that becomes readable when something arrives; -1: the link is cut.
  virtual int descriptor() const = 0;

  // The tick of the command that the voltage returned by the last Drive() came from; -1: it came from none.
  virtual int64_t acting_command_tick() const = 0;
};

class Rig {
 public:
  virtual ~Rig() = default;

  // The role under which the rig is announced on the bus: "plant" or "driver".
  virtual std::string role() const = 0;

  // The sensors' readings at `tick`; NaN: not measured, or not credible. Called for tick 0 first, then for
  // increasing ticks. A simulated actuator advances to that tick under the voltage of the last Drive().
  // Throws RigError.
  virtual model::Measurement Read(int64_t tick) = 0;

  // What is wrong with the last reading. While this is not empty, only zero volts may be driven.
  virtual const std::vector<RigFault>& faults() const = 0;

  // Holds the amplifier voltage (V, of eq. (1)) from now on; it is zero before the first call. Returns the
  // voltage that actually acts, which a limit may have reduced. Throws RigError.
  virtual double Drive(double voltage) = 0;

  // States the tick of the command that the voltage of the next Drive() comes from; -1: the voltage is zero
  // because something is wrong or no process sends commands.
  virtual void Obey(int64_t /*command_tick*/) {}

  // Null for a rig that samples when it is read.
  virtual Pacemaker* pacemaker() { return nullptr; }

  // Called often until the run begins; nothing is read or driven during that time.
  virtual void Attend() {}

  // The total number of messages from the machine that were lost on their way.
  virtual int64_t lost_messages() const { return 0; }

  // Sets the noise that a simulated rig's sensors have from now on; a real rig's sensors have their own.
  virtual void SetNoise(const settings::NoiseSection&) {}
  virtual bool simulated() const { return false; }

  // Puts out zero volts by any means left. May be called at any time and repeatedly.
  virtual OutputLeft Zero() noexcept = 0;
  // What a Zero() that has to wait for its device's answer calls meanwhile, once: the others shall hear why
  // no states come before they miss them.
  void set_when_late(std::function<void()> tell) { when_late_ = std::move(tell); }

 protected:
  std::function<void()> when_late_;
};

}  // namespace hydro::plant
