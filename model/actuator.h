// The simulated actuator: eqs. (1) to (15) with their switches and effects, advanced in time. What the plant
// process, the figures and the gap finder run.
#pragma once

#include <limits>
#include <memory>
#include <stdexcept>

#include "model/description.h"
#include "trajectory/trajectory.h"

namespace hydro::model {

// The model cannot go on: V_1 or V_2 would reach 0 (what() names angle and limit), a step failed or a value
// is not finite (what() names time and state), or the conditions contradict the model.
class ModelError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ActuatorOptions {
  Shaft shaft = Shaft::kFree;
  double arm_angle = 0;  // rad, clamped: where; free: where the arm starts
  const trajectory::Trajectory* motion =
      nullptr;          // rad over s, driven: the arm's angle; must be continuous and outlive the Actuator
  bool bypass = false;  // the two sides are connected: p1 = p2
  double initial_pressure = std::numeric_limits<double>::quiet_NaN();  // psi, both sides; NaN: p_3
  Integrator integrator = Integrator::kAuto;
  double relative_tolerance = 1e-8;
  // An effect may be there more than once: for derivatives by several of them at no size.
  bool repeated_effects = false;
};

// What the sensors would read without noise. Units of the model. T is double, or a scalar that carries
// derivatives.
template <class T>
struct MeasurementOf {
  T motor_angle{};
  T motor_speed{};
  T arm_angle{};
  T arm_speed{};
  T p1{};
  T p2{};
};
using Measurement = MeasurementOf<double>;

class Actuator {
 public:
  // Throws ModelError, e.g. "arm angle 1.5708 rad leaves V_1 = -2.63 in^3; V_1, V_2 > 0 needs |alpha| <
  // 0.8578 rad".
  Actuator(const ModelDescription& description, const ActuatorOptions& options);
  ~Actuator();
  Actuator(Actuator&&) noexcept;
  Actuator& operator=(Actuator&&) noexcept;

  // Advances to time `until` (s, not before time()) with the amplifier voltage held. Results do not depend on
  // anything but the sequence of calls: bit-identical for identical calls. Throws ModelError.
  void Advance(double voltage, double until);

  double time() const;
  Measurement Measure() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydro::model
