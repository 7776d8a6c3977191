#include "position_ctrl/law/position_law.h"

#include <algorithm>
#include <cmath>

namespace hydro::position_ctrl {

// Eq. (17).
double PositionLaw::Update(double arm_angle, double arm_ref, int64_t intervals) {
  const double error = arm_angle - arm_ref;
  const double differentiated = settings_.derivative_on_error ? error : arm_angle;
  double pressure_ref = -settings_.c1 * error;
  if (has_previous_) {
    const double elapsed = settings_.sample_interval * static_cast<double>(intervals);
    pressure_ref -= settings_.c2 / elapsed * (differentiated - previous_);
  }
  previous_ = differentiated;
  has_previous_ = true;
  return std::clamp(pressure_ref, -settings_.pressure_limit, settings_.pressure_limit);
}

double QuantiseDac(double value, int bits, double full_scale) {
  if (bits == 0) return value;
  const double half = std::ldexp(1.0, bits - 1);
  const double step = full_scale / half;
  return std::clamp(std::nearbyint(value / step), -half, half - 1) * step;
}

}  // namespace hydro::position_ctrl
