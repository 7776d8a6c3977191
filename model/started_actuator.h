// The simulated actuator from a state of motion, such as a measured one: what runs beside a rig and is set to it now and then.
#pragma once

#include <memory>

#include "model/actuator.h"
#include "model/response.h"

namespace hydro::model {

class StartedActuator {
 public:
  // At `time` (s; what effects call t begins at options.begin) in the state `start`, as Respond begins; of the options, the
  // start's pressures and arm angle are not used. Throws ModelError as Actuator does.
  StartedActuator(const ModelDescription& description, const ActuatorOptions& options,
                  const StartState& start, double time);
  ~StartedActuator();
  StartedActuator(StartedActuator&&) noexcept;
  StartedActuator& operator=(StartedActuator&&) noexcept;

  // As those of Actuator.
  void Advance(double voltage, double until);
  double time() const;
  Measurement Measure() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydro::model
