// The simulated actuator: eqs. (1) to (15) with their switches and effects, advanced in time. The plant
// process, the figures and the gap finder all run it.
#pragma once

#include <memory>

#include "model/terms/actuator_options.h"
#include "model/terms/description.h"
#include "model/terms/measurement.h"
#include "model/terms/model_error.h"

namespace hydro::model {

class Actuator {
 public:
  // Throws ModelError, e.g. "arm angle 1.5708 rad leaves V_1 = -2.63 in^3; V_1, V_2 > 0 needs |alpha| <
  // 0.8578 rad".
  Actuator(const ModelDescription& description, const ActuatorOptions& options);
  ~Actuator();
  Actuator(Actuator&&) noexcept;
  Actuator& operator=(Actuator&&) noexcept;

  // Advances to time `until` (s, not before time()) with the amplifier voltage held. Results depend only on
  // the sequence of calls: identical calls give identical bits. Throws ModelError.
  void Advance(double voltage, double until);

  double time() const;
  Measurement Measure() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydro::model
