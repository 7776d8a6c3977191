// The control law of the position loop, eq. (17), and what shapes the reference that it follows. All of it is
// pure.
#pragma once

#include <cstdint>
#include <limits>

namespace hydro::position_ctrl {

struct PositionLawSettings {
  double c1 = 0;                   // psi/rad
  double c2 = 0;                   // psi s/rad
  double sample_interval = 0.005;  // s, T
  // true: eq. (17) as printed; false: the derivative acts on the measured angle, so a step gives no kick.
  bool derivative_on_error = false;
  double pressure_limit = std::numeric_limits<double>::infinity();  // psi, largest |dp_ref|
};

// Eq. (17). Its only state is the previous sample.
class PositionLaw {
 public:
  explicit PositionLaw(const PositionLawSettings& settings) : settings_(settings) {}

  // Eq. (17), limited: dp_ref = -c1 e - c2/T (e - e_previous), e = alpha - alpha_ref. `intervals` is the
  // number of sample intervals since the previous call (more than 1 when samples were missed). The first
  // sample after Reset() has no derivative term.
  double Update(double arm_angle, double arm_ref, int64_t intervals) {
    return Limited(UpdateUnlimited(arm_angle, arm_ref, intervals));
  }

  // UpdateUnlimited() does the same without the limit; Limited() applies the limit.
  double UpdateUnlimited(double arm_angle, double arm_ref, int64_t intervals);
  double Limited(double pressure_ref) const;

  // The result that UpdateUnlimited() would give with other settings; the law itself stays unchanged.
  double Preview(const PositionLawSettings& other, double arm_angle, double arm_ref, int64_t intervals) const;

  // Acts by other settings from the next Update() on. The previous sample is kept.
  void Retune(const PositionLawSettings& settings);

  void Reset() { has_previous_ = false; }

 private:
  PositionLawSettings settings_;
  double previous_error_ = 0;  // rad, of the previous sample
  double previous_angle_ = 0;  // rad
  bool has_previous_ = false;
};

// Changes how eq. (17) sees a large error of the arm's angle, so that the motor can still brake in time.
//
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

// Brings the reference back after the plant has held the motor at zero volts. The arm may have moved far in
// that time, and nobody expects a jump: the reference starts at the arm's present angle.
class ReferenceReturn {
 public:
  // `ticks` is the number of plant ticks in which the reference goes from the arm's angle to the wanted one;
  // 0: at once.
  explicit ReferenceReturn(int64_t ticks) : ticks_(ticks) {}

  // Call it once for each state. `driven` means that a command is in force that may move the motor. Before
  // the first such command nothing is held: the run only begins. `present` is the measured value of the
  // quantity to which the reference refers.
  void Observe(int64_t tick, bool driven, double present) {
    if (!driven || held_ || !begun_) ObserveChange(tick, driven, present);
  }

  // This loop joins a run that has gone on without it; the reference behaves as after a hold.
  void Join() { begun_ = held_ = true; }

  // The reference for the sample at `tick`: `wanted` in normal operation; the last measured value while the
  // motor is held; in between, a straight line from one to the other.
  double Reference(double wanted, int64_t tick);

  // Another reference is followed from `tick` on. It is reached in the same way, starting at `from`, the
  // value of the previous one.
  void Depart(double from, int64_t tick);

  // Begins another run.
  void Reset() { *this = ReferenceReturn(ticks_); }

 private:
  void ObserveChange(int64_t tick, bool driven, double present);

  int64_t ticks_;
  bool begun_ = false;      // a command has been in force
  bool held_ = false;       // no command is in force any more
  bool returning_ = false;  // a command is in force again
  int64_t returned_ = 0;    // since this tick
  double from_ = 0;
};

// The output of a D/A converter of `bits` bits and a range of +/- full_scale for `value`: the nearest of its
// 2^bits levels k full_scale / 2^(bits-1), k = -2^(bits-1) ... 2^(bits-1) - 1. With `bits` = 0, `value`
// itself.
double QuantiseDac(double value, int bits, double full_scale);

}  // namespace hydro::position_ctrl
