#include "position_ctrl/law/position_law.h"

#include <algorithm>
#include <cmath>

namespace hydro::position_ctrl {

double PositionLaw::UpdateUnlimited(double arm_angle, double arm_ref, int64_t intervals) {
  const double pressure_ref = Preview(settings_, arm_angle, arm_ref, intervals);
  previous_error_ = arm_angle - arm_ref;
  previous_angle_ = arm_angle;
  has_previous_ = true;
  return pressure_ref;
}

// Eq. (17).
double PositionLaw::Preview(const PositionLawSettings& settings, double arm_angle, double arm_ref,
                            int64_t intervals) const {
  const double error = arm_angle - arm_ref;
  double pressure_ref = -settings.c1 * error;
  if (has_previous_) {
    const double elapsed = settings.sample_interval * static_cast<double>(intervals);
    const double difference =
        settings.derivative_on_error ? error - previous_error_ : arm_angle - previous_angle_;
    pressure_ref -= settings.c2 / elapsed * difference;
  }
  return pressure_ref;
}

double PositionLaw::Limited(double pressure_ref) const {
  return std::clamp(pressure_ref, -settings_.pressure_limit, settings_.pressure_limit);
}

void PositionLaw::Retune(const PositionLawSettings& settings) { settings_ = settings; }

double QuantiseDac(double value, int bits, double full_scale) {
  if (bits == 0) return value;
  const double half = std::ldexp(1.0, bits - 1);
  const double step = full_scale / half;
  return std::clamp(std::nearbyint(value / step), -half, half - 1) * step;
}

}  // namespace hydro::position_ctrl
