// motor.speed_torque_limit: abs(T) <= T_max (1 - abs(theta')/no_load_speed) while driving, with T_max =
// T_pmax: what the supply's voltage leaves above the motor's back EMF. It acts on T_p after every other
// limit, lag and delay. While braking (torque against speed) only T_pmax limits. One switch: 0, not limited;
// +1 and -1, on the line in that direction; +2 and -2, turning faster than no_load_speed in that direction,
// where no torque is left to drive with.

#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class SpeedTorqueLimit : public EffectOf<SpeedTorqueLimit> {
 public:
  int switches() const override { return 1; }

  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    x.torque_asked = x.torque;
    const int position = Position(x);
    if (position == 0) return;
    const double side = position > 0 ? 1 : -1;
    x.torque = std::abs(position) == 1 ? T(side * Line(x, side)) : T(0.0);
  }

  template <class T>
  void OwnMargins(const Terms<T>& x, T* margin) const {
    T& own = margin[kFirstEffectSwitch + first_switch()];
    const int position = Position(x);
    const double side = Side(x);
    const T line = Line(x, side);
    const T asked = side * x.torque_asked;
    if (position == 0) {
      own = std::max<T>(line, T(0.0)) - asked;
    } else if (std::abs(position) == 1) {
      own = std::min<T>(asked - line, line);
    } else {
      own = std::min<T>(-line, asked);
    }
  }

  template <class T>
  void OwnCross(int /*which*/, const Terms<T>& x, T* /*state*/, Mode* mode) const {
    int8_t& position = mode->effects[first_switch()];
    const double side = Side(x);
    const int sign = side > 0 ? 1 : -1;
    const T line = Line(x, side);
    const T asked = side * x.torque_asked;
    if (position == 0) {
      position = static_cast<int8_t>(line > T(0.0) ? sign : 2 * sign);
    } else if (std::abs(position) == 1) {
      position = static_cast<int8_t>(asked - line < line ? 0 : 2 * sign);
    } else {
      position = static_cast<int8_t>(asked < -line ? 0 : sign);
    }
  }

 private:
  template <class T>
  int Position(const Terms<T>& x) const {
    return x.mode->effects[first_switch()];
  }
  // The direction of the limit that acts, or of the one that could.
  template <class T>
  double Side(const Terms<T>& x) const {
    const int position = Position(x);
    if (position != 0) return position > 0 ? 1 : -1;
    return x.torque_asked < T(0.0) ? -1 : 1;
  }
  // Against the direction of the speed, the line lies above T_pmax and so does not limit.
  template <class T>
  static T Line(const Terms<T>& x, double side) {
    return x.parameters->T_pmax * (1.0 - side * x.motor_speed / x.own[0]);
  }
};

[[maybe_unused]] const bool kAdded =
    AddToCatalogue({.info = {.id = "motor.speed_torque_limit",
                             .summary = "the motor's largest torque falls with speed",
                             .equation = "abs(T) <= T_max (1 - abs(theta')/no_load_speed) while driving",
                             .confused_with = "pump.quadratic_drag",
                             .parameters = {{.name = "no_load_speed",
                                             .unit = "rad/s",
                                             .min_allowed = false,
                                             .meaning = "speed at which no torque is left",
                                             .starts = {1.1, 1.6, 3, 30},
                                             .scale = Scale::kSpeed,
                                             .example = 300}}},
                    .make = MakeEffect<SpeedTorqueLimit>});

}  // namespace

}  // namespace hydro::model
