// motor.cogging: T -= amplitude sin(periods theta + phase), a conservative torque of the motor's magnets. It
// also acts on the pump at rest, where friction holds it.

#include <cmath>
#include <numbers>

#include "model/effects/shaft_torque.h"
#include "model/effects/shared_parameters.h"

namespace hydro::model {

namespace {

struct Cogging {
  template <class T>
  static T& Load(Terms<T>& x) {
    return x.load;
  }
  template <class T>
  static T Torque(const Terms<T>& x) {
    using std::sin;
    return x.own[0] * sin(x.own[1] * x.motor_angle + x.own[2]);
  }
};

[[maybe_unused]] const bool kMotorCoggingAdded =
    AddToCatalogue({.info = {.id = "motor.cogging",
                             .summary = "the motor's magnets pull towards fixed angles",
                             .equation = "T -= amplitude sin(periods theta + phase)",
                             .confused_with = "pump.flow_ripple",
                             .parameters = {{.name = "amplitude",
                                             .unit = "in-lbf",
                                             .min = -kUnbounded,
                                             .meaning = "largest cogging torque; negative: half a period on",
                                             .role = Role::kTorqueWave,
                                             .example = 2},
                                            PeriodsPerRevolution(12),
                                            {.name = "phase",
                                             .unit = "rad",
                                             .min = -kUnbounded,
                                             .meaning = "phase at theta = 0",
                                             .starts = {0, std::numbers::pi / 2},
                                             .role = Role::kPhase,
                                             .example = 0.4}}},
                    .make = MakeEffect<ShaftTorque<Cogging>>});

}  // namespace

}  // namespace hydro::model
