#include "position_ctrl/law/position_law.h"

#include <algorithm>
#include <cmath>

namespace hydro::position_ctrl {

void ReferenceReturn::ObserveChange(int64_t tick, bool driven, double present) {
  // Stored at every state, so that a hold between two samples also starts at the arm's present angle.
  const bool hold = held_ || (begun_ && !driven);
  if (hold && std::isfinite(present)) from_ = present;
  if (driven && held_) {
    held_ = false;
    returning_ = ticks_ > 0;
    returned_ = tick;
  } else if (!driven && begun_) {
    held_ = true;
  }
  begun_ = begun_ || driven;
}

void ReferenceReturn::Depart(double from, int64_t tick) {
  if (held_) return;  // after the hold, the reference comes back to the new one
  from_ = from;
  returning_ = ticks_ > 0;
  returned_ = tick;
}

double ReferenceReturn::Reference(double wanted, int64_t tick) {
  if (held_) return from_;
  if (!returning_) return wanted;
  const double share = static_cast<double>(tick - returned_) / static_cast<double>(ticks_);
  if (share >= 1) {
    returning_ = false;
    return wanted;
  }
  return from_ + share * (wanted - from_);
}

// The parabola sqrt(2 a e) has the line's slope k at e = a/(2 k^2), where it is twice as high as the line:
// a/k against a/(2 k).
BrakingCurve::BrakingCurve(double c1_per_c2, double deceleration, double largest_speed)
    : slope_(c1_per_c2),
      deceleration_(deceleration),
      largest_speed_(largest_speed),
      straight_within_(deceleration / (2 * c1_per_c2 * c1_per_c2)) {}

double BrakingCurve::Speed(double error) const {
  const double size = std::fabs(error);
  const double speed = size <= straight_within_
                           ? slope_ * size
                           : std::sqrt(2 * deceleration_ * size) - deceleration_ / (2 * slope_);
  return std::copysign(std::min(speed, largest_speed_), error);
}

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
