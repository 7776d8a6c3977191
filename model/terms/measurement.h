// What the sensors would read without noise.
#pragma once

namespace hydro::model {

// In the model's units. T is double, or a scalar with derivatives.
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

}  // namespace hydro::model
