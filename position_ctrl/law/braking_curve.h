// A large error of the arm's angle as eq. (17) should see it, so that the motor can still brake in time. Pure.
#pragma once

#include <limits>

namespace hydro::position_ctrl {

// Eq. (17) with the derivative on the measured angle drives the arm towards the speed c1/c2 times its error. That is a straight
// line through the target, and a motor at its torque limit cannot follow it: from a small error the line is slower than
// the motor could be, from a large one faster than it can brake. This curve replaces the line beyond a small error by the
// parabola of constant deceleration, as proximate time-optimal servos do: speed = sqrt(2 deceleration |e|), less what makes
// the two meet with one slope. Near the target eq. (17) is as it was, so its margins are too.
class BrakingCurve {
 public:
  // c1/c2 of eq. (17) in 1/s, above 0. deceleration: rad/s^2, at most what the motor can brake with; infinity: eq. (17) as it
  // is. largest_speed: of the arm, rad/s.
  BrakingCurve(double c1_per_c2, double deceleration,
               double largest_speed = std::numeric_limits<double>::infinity());

  // The speed, rad/s, at which the arm should approach a target that is `error` (rad, target less angle) away.
  double Speed(double error) const;

  // The reference for PositionLaw::Update in the place of `wanted`: where the straight line asks for the same speed.
  double Reference(double arm_angle, double wanted) const {
    return arm_angle + Speed(wanted - arm_angle) / slope_;
  }

  // rad: up to this error eq. (17) is as it was.
  double straight_within() const { return straight_within_; }

 private:
  double slope_;
  double deceleration_;
  double largest_speed_;
  double straight_within_;
};

}  // namespace hydro::position_ctrl
