// gear.load_friction: Coulomb friction that grows with what a gear transmits, on both of its sides:
// + (motor_share |T_p| + load_share |L|) sgn(theta'). L is the shaft's load besides friction: D dp and every
// other load. With a load_share of 1 or more the load cannot turn the motor, as in a worm gear. While the
// motor drives, its own share takes the same part of the torque as a smaller k_1 would.

#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class LoadFriction : public EffectOf<LoadFriction> {
 public:
  // Every torque on the shaft is known by now.
  template <class T>
  void OwnStates(Terms<T>& x, T* /*rate*/) const {
    const T friction = x.own[0] * Size(x, x.torque) + x.own[1] * Size(x, T(x.torque - x.net_torque));
    x.coulomb += friction;
    x.breakaway += friction;
  }

 private:
  // |y| is approximated by sqrt(y^2 + w^2) - w with w = 1e-3 T_pmax, whose slope at y = 0 does not jump.
  template <class T>
  static T Size(const Terms<T>& x, const T& y) {
    using std::sqrt;
    const T w = 1e-3 * x.parameters->T_pmax;
    return sqrt(y * y + w * w) - w;
  }
};

[[maybe_unused]] const bool kGearLoadFrictionAdded = AddToCatalogue(
    {.info = {.id = "gear.load_friction",
              .summary = "friction grows with the torque that a gear transmits",
              .equation = "+ (motor_share abs(T_p) + load_share abs(D dp + other loads)) sgn(theta')",
              .confused_with = "pump.pressure_friction, pump.stribeck, parameters k_1 and T_s",
              .parameters = {{.name = "motor_share",
                              .unit = "1",
                              .max = 1,
                              .meaning = "friction per torque of the motor",
                              .example = 0.1,
                              .optional = true,
                              // In most runs the motor drives, and there it looks like a smaller k_1.
                              .standard = 0.0},
                             {.name = "load_share",
                              .unit = "1",
                              .meaning = "friction per torque of the load",
                              .example = 0.15}},
              // With oil it is the same as friction of the pump, by D dp, and of the seals, by the arm's
              // load.
              .of_bare_motors = true},
     .make = MakeEffect<LoadFriction>});

}  // namespace

}  // namespace hydro::model
