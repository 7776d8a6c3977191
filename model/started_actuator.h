// The simulated actuator started from a state of motion, such as a measured one. It runs beside a rig and is
// set to the rig's state from time to time.
#pragma once

#include <memory>

#include "model/actuator.h"
#include "model/response.h"

namespace hydro::model {

class StartedActuator {
 public:
  // Begins at `time` (s) in the state `start`, as Respond does; the effects' t counts from options.begin. The
  // pressures and the arm angle in `options` are not used. Throws ModelError as Actuator does.
  StartedActuator(const ModelDescription& description, const ActuatorOptions& options,
                  const StartState& start, double time);
  ~StartedActuator();
  StartedActuator(StartedActuator&&) noexcept;
  StartedActuator& operator=(StartedActuator&&) noexcept;

  // As in Actuator.
  void Advance(double voltage, double until);
  double time() const;
  Measurement Measure() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydro::model
