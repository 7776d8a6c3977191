// A limit of the motor's torque that falls with speed while the motor drives, for the effects that define the
// line. It acts on T_p after every other limit, lag and delay. While braking (torque against speed) only
// T_pmax limits. The switch has these positions: 0, not limited; +1 and -1, on the line in that direction; +2
// and -2, turning so fast in that direction that no driving torque is left.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

// LimitLine::Torque(x, speed) is the largest torque in the direction of a speed; T_pmax or more where it does
// not limit.
template <class LimitLine>
class TorqueLine : public EffectOf<TorqueLine<LimitLine>> {
 public:
  using EffectOf<TorqueLine<LimitLine>>::first_switch;

  int switches() const override { return 1; }
  bool limits_torque() const override { return true; }

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
  // The direction of the limit that acts, or of the one that may act next.
  template <class T>
  double Side(const Terms<T>& x) const {
    const int position = Position(x);
    if (position != 0) return position > 0 ? 1 : -1;
    return x.torque_asked < T(0.0) ? -1 : 1;
  }
  // Against the direction of the speed, the line lies above T_pmax and so does not limit.
  template <class T>
  static T Line(const Terms<T>& x, double side) {
    return LimitLine::Torque(x, T(side * x.motor_speed));
  }
};

}  // namespace hydro::model
