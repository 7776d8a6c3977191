// What stands for the machine in a simulated rig: the actuator alone, or its part of something larger.
#pragma once

#include <memory>

#include "model/actuator.h"
#include "settings/stack_config.h"

namespace hydro::plant {

class SimulatedMachine {
 public:
  virtual ~SimulatedMachine() = default;

  // Holds the amplifier's voltage, V, from now on.
  virtual void Hold(double voltage) noexcept = 0;

  // Advances to time `until`, s, under the voltage that is held. Throws ModelError.
  virtual void Advance(double until) = 0;

  virtual model::Measurement Measure() const = 0;
};

// The options that a configuration states for its actuator, except the motion of a driven shaft.
model::ActuatorOptions ActuatorOptionsOf(const settings::StackConfig& config);

// Makes the actuator alone. Throws InputError when the configuration and the model contradict each other.
std::unique_ptr<SimulatedMachine> MakeActuator(const settings::StackConfig& config);

}  // namespace hydro::plant
