// What a PlantApp runs on: the simulated actuator (simulated_rig.h) or a board in front of a real one.
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/actuator.h"

namespace hydro::plant {

// Something that a rig says about itself; the fields are those of fault_t.
struct RigFault {
  std::string code;  // docs/faults.md
  std::string text;  // one line: what was found and what is allowed
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

class Rig {
 public:
  virtual ~Rig() = default;

  // Under which role it is announced on the bus: "plant" or "driver".
  virtual std::string role() const = 0;

  // What the sensors read at `tick`; NaN: not measured, or not to be believed. Tick 0 comes first, later ones
  // follow in increasing order. A simulated actuator gets there under the voltage of the last Drive(). Throws
  // RigError.
  virtual model::Measurement Read(int64_t tick) = 0;

  // What is wrong with the last reading; as long as anything is, no voltage but zero may be driven.
  virtual const std::vector<RigFault>& faults() const = 0;

  // Holds the amplifier voltage (V, of eq. (1)) from now on; before the first call it is zero. Returns the
  // voltage that really acts, which a limit may have cut. Throws RigError.
  virtual double Drive(double voltage) = 0;

  // Zero volts, by whatever means are left. At any time, any number of times.
  virtual void Zero() noexcept = 0;
};

}  // namespace hydro::plant
