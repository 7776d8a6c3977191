// motor.current_limit: the amplifier's current limit is constant up to `corner_speed` and falls from there to
// zero over `speed_range`: abs(T) <= T_max (1 - (abs(theta') - corner_speed)/speed_range) while driving,
// T_max = T_pmax (torque_line.h).

#include "model/effects/drive/torque_line.h"

namespace hydro::model {

namespace {

struct FallsFromCorner {
  template <class T>
  static T Torque(const Terms<T>& x, const T& speed) {
    return x.parameters->T_pmax * (1.0 - (speed - x.own[0]) / x.own[1]);
  }
};

[[maybe_unused]] const bool kMotorCurrentLimitAdded = AddToCatalogue(
    {.info = {.id = "motor.current_limit",
              .summary = "the amplifier's current limit falls above a speed",
              .equation = "abs(T) <= T_max (1 - (abs(theta') - corner_speed)/speed_range) while driving",
              .confused_with = "motor.speed_torque_limit",
              .parameters = {{.name = "corner_speed",
                              .unit = "rad/s",
                              .meaning = "speed up to which T_pmax is there",
                              .starts = {0.5},
                              .scale = Scale::kSpeed,
                              .example = 4},
                             {.name = "speed_range",
                              .unit = "rad/s",
                              .min_allowed = false,
                              .meaning = "from there to the speed at which no torque is left",
                              .starts = {0.7, 1.5},
                              .scale = Scale::kSpeed,
                              .example = 16}},
              // motor.speed_torque_limit is nearly the same with one parameter less.
              .on_request = true},
     .make = MakeEffect<TorqueLine<FallsFromCorner>>});

}  // namespace

}  // namespace hydro::model
