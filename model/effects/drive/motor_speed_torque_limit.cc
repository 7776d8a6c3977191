// motor.speed_torque_limit: abs(T) <= T_max (1 - abs(theta')/no_load_speed) while driving, with T_max =
// T_pmax. It is the torque that the supply's voltage leaves above the motor's back EMF (torque_line.h).

#include "model/effects/drive/torque_line.h"

namespace hydro::model {

namespace {

struct FallsFromRest {
  template <class T>
  static T Torque(const Terms<T>& x, const T& speed) {
    return x.parameters->T_pmax * (1.0 - speed / x.own[0]);
  }
};

[[maybe_unused]] const bool kMotorSpeedTorqueLimitAdded =
    AddToCatalogue({.info = {.id = "motor.speed_torque_limit",
                             .summary = "the motor's largest torque falls with speed",
                             .equation = "abs(T) <= T_max (1 - abs(theta')/no_load_speed) while driving",
                             .confused_with = "pump.quadratic_drag, motor.current_limit",
                             .parameters = {{.name = "no_load_speed",
                                             .unit = "rad/s",
                                             .min_allowed = false,
                                             .meaning = "speed at which no torque is left",
                                             .starts = {1.1, 1.6, 3, 30},
                                             .scale = Scale::kSpeed,
                                             .example = 300}}},
                    .make = MakeEffect<TorqueLine<FallsFromRest>>});

}  // namespace

}  // namespace hydro::model
