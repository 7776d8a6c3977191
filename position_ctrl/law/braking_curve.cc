#include "position_ctrl/law/braking_curve.h"

#include <algorithm>
#include <cmath>

namespace hydro::position_ctrl {

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

}  // namespace hydro::position_ctrl
