// gear.motor_friction: Coulomb friction that grows with the motor's torque, + motor |T_p| sgn(theta'), on the
// motor's side of a gear. While the motor drives, it takes the same part of the torque as a smaller k_1
// would.

#include "model/effects/drive/gear_friction.h"

namespace hydro::model {

namespace {

struct MotorSide {
  template <class T>
  static T Torque(const Terms<T>& x) {
    return x.torque;
  }
};

[[maybe_unused]] const bool kGearMotorFrictionAdded =
    AddToCatalogue({.info = {.id = "gear.motor_friction",
                             .summary = "friction grows with the motor's torque",
                             .equation = "+ motor abs(T_p) sgn(theta')",
                             .confused_with = "parameter k_1, gear.load_friction",
                             .parameters = {{.name = "motor",
                                             .unit = "1",
                                             .max = 1,
                                             .meaning = "friction per torque of the motor",
                                             .example = 0.1}},
                             // In most runs the motor drives, and there it looks like a smaller k_1.
                             .on_request = true},
                    .make = MakeEffect<GearFriction<MotorSide>>});

}  // namespace

}  // namespace hydro::model
