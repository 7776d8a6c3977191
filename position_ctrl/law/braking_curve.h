// Changes how eq. (17) sees a large error of the arm's angle, so that the motor can still brake in time.
// Pure.
#pragma once

#include <limits>

namespace hydro::position_ctrl {

// Eq. (17) with the derivative on the measured angle drives the arm towards the speed c1/c2 times its error.
// That speed is a straight line through the target, and a motor at its torque limit cannot follow it: at a
// small error the line is slower than the motor could be, at a large one faster than the motor can brake.
// Beyond a small error, this curve replaces the line by the parabola of constant deceleration, as proximate
// time-optimal servos do: speed = sqrt(2 deceleration |e|), less the amount that makes the two meet with one
// slope. Near the target eq. (17) is unchanged, and so are its margins.
class BrakingCurve {
 public:
  // `c1_per_c2` is c1/c2 of eq. (17) in 1/s, above 0. `deceleration` is in rad/s^2, at most that with which
  // the motor can brake; infinity leaves eq. (17) unchanged. `largest_speed` is that of the arm, rad/s.
  BrakingCurve(double c1_per_c2, double deceleration,
               double largest_speed = std::numeric_limits<double>::infinity());

  // The speed, rad/s, at which the arm should approach a target at the distance `error` (rad, target less
  // angle).
  double Speed(double error) const;

  // The reference for PositionLaw::Update instead of `wanted`: the one for which the straight line gives the
  // same speed.
  double Reference(double arm_angle, double wanted) const {
    return arm_angle + Speed(wanted - arm_angle) / slope_;
  }

  // rad: up to this error eq. (17) is unchanged.
  double straight_within() const { return straight_within_; }

 private:
  double slope_;
  double deceleration_;
  double largest_speed_;
  double straight_within_;
};

}  // namespace hydro::position_ctrl
