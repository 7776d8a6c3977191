// gear.friction_ripple: friction that varies over a turn, as with a bent shaft or an eccentric gear: T_s
// becomes T_s (1 + amplitude sin(periods theta + phase)).

#include <cmath>
#include <numbers>

#include "model/effects/shared_parameters.h"

namespace hydro::model {

namespace {

class FrictionRipple : public EffectOf<FrictionRipple> {
 public:
  template <class T>
  void OwnProperties(Terms<T>& x) const {
    using std::sin;
    x.T_s *= 1.0 + x.own[0] * sin(x.own[1] * x.motor_angle + x.own[2]);
  }
};

[[maybe_unused]] const bool kGearFrictionRippleAdded =
    AddToCatalogue({.info = {.id = "gear.friction_ripple",
                             .summary = "friction varies over a turn",
                             .equation = "T_s becomes T_s (1 + amplitude sin(periods theta + phase))",
                             .confused_with = "motor.cogging where the motor turns in one direction",
                             .parameters = {{.name = "amplitude",
                                             .unit = "1",
                                             .min = -1,
                                             .max = 1,
                                             .meaning = "part of T_s; negative: half a period on",
                                             .example = 0.3},
                                            {.name = "periods",
                                             .unit = "1/rev",
                                             .max = kMostPeriods,
                                             .min_allowed = false,
                                             .meaning = "periods in one revolution",
                                             .starts = {1, 2, 3, 4},
                                             .example = 1,
                                             .beyond_max = kOfMorePeriods},
                                            {.name = "phase",
                                             .unit = "rad",
                                             .min = -kUnbounded,
                                             .meaning = "phase at theta = 0",
                                             .starts = {0, std::numbers::pi / 2},
                                             .example = 0.4}},
                             // In motion in one direction it is the same as cogging.
                             .on_request = true},
                    .make = MakeEffect<FrictionRipple>});

}  // namespace

}  // namespace hydro::model
