// gear.load_friction: Coulomb friction that grows with the torque of the load, + load |L| sgn(theta'). L is
// the shaft's load besides friction: D dp and every other load. With `load` of 1 or more the load cannot turn
// the motor, as in a worm gear.

#include "model/effects/drive/gear_friction.h"

namespace hydro::model {

namespace {

struct LoadSide {
  template <class T>
  static T Torque(const Terms<T>& x) {
    return x.torque - x.net_torque;
  }
};

[[maybe_unused]] const bool kGearLoadFrictionAdded =
    AddToCatalogue({.info = {.id = "gear.load_friction",
                             .summary = "friction grows with the torque of the load",
                             .equation = "+ load abs(D dp + other loads) sgn(theta')",
                             .confused_with = "pump.pressure_friction, gear.motor_friction, parameter T_s",
                             .parameters = {{.name = "load",
                                             .unit = "1",
                                             .meaning = "friction per torque of the load",
                                             .example = 0.15}},
                             // With oil it is the same as friction of the pump, by D dp, and of the seals, by
                             // the arm's load.
                             .of_bare_motors = true},
                    .make = MakeEffect<GearFriction<LoadSide>>});

}  // namespace

}  // namespace hydro::model
