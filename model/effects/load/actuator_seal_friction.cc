// actuator.seal_friction: arm torque - coulomb sgn(alpha') - viscous alpha'. The arm sticks while the net
// torque on it is within `coulomb`. One switch: 0, the arm sticks; +1 and -1, it moves in that direction.
// With a clamped or driven shaft the effect does nothing.

#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class SealFriction : public EffectOf<SealFriction> {
 public:
  int switches() const override { return 1; }

  template <class T>
  void OwnStartMode(const Terms<T>& x, Mode* mode) const {
    if (!x.arm_free) return;
    mode->effects[first_switch()] = x.arm_speed > T(0.0) ? 1 : (x.arm_speed < T(0.0) ? -1 : 0);
  }

  // Applied once every torque on the arm is known.
  template <class T>
  void OwnStates(Terms<T>& x, T* /*rate*/) const {
    if (!x.arm_free) return;
    x.arm_load = x.arm_torque;
    const int direction = x.mode->effects[first_switch()];
    if (direction == 0) {
      x.arm_torque = T(0.0);
    } else {
      x.arm_torque -= static_cast<double>(direction) * x.own[0] + x.own[1] * x.arm_speed;
    }
  }

  template <class T>
  void OwnMargins(const Terms<T>& x, T* margin) const {
    using std::abs;
    const int direction = x.mode->effects[first_switch()];
    T& own = margin[kFirstEffectSwitch + first_switch()];
    if (!x.arm_free) {
      own = T(1.0);
    } else if (direction == 0) {
      own = x.own[0] - abs(x.arm_load);
    } else {
      own = static_cast<double>(direction) * x.arm_speed;
    }
  }

  template <class T>
  void OwnCross(int /*which*/, const Terms<T>& x, T* state, Mode* mode) const {
    using std::abs;
    int8_t& direction = mode->effects[first_switch()];
    if (direction != 0) state[kArmSpeed] = T(0.0);
    direction = abs(x.arm_load) <= x.own[0] ? 0 : (x.arm_load > T(0.0) ? 1 : -1);
  }

  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    if (!x.arm_free) return;
    power->effects_dissipated += x.own[0] * std::abs(x.arm_speed) + x.own[1] * x.arm_speed * x.arm_speed;
  }
};

[[maybe_unused]] const bool kActuatorSealFrictionAdded =
    AddToCatalogue({.info = {.id = "actuator.seal_friction",
                             .summary = "friction of the actuator's seals and the arm's bearing",
                             .equation = "arm torque - coulomb sgn(alpha') - viscous alpha'",
                             .confused_with = "parameter m g l on one-way motion",
                             .parameters = {{.name = "coulomb",
                                             .unit = "in-lbf",
                                             .meaning = "Coulomb friction on the arm",
                                             .arm = -1,
                                             .example = 100},
                                            {.name = "viscous",
                                             .unit = "in-lbf-s",
                                             .meaning = "viscous friction on the arm",
                                             .arm = -2,
                                             .example = 50}},
                             .needs_oil = true},
                    .make = MakeEffect<SealFriction>});

}  // namespace

}  // namespace hydro::model
