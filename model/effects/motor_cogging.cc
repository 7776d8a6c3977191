// motor.cogging: T -= amplitude sin(periods theta + phase), a conservative torque of the motor's magnets. It
// also acts on the pump at rest, where friction holds it.

#include <cmath>
#include <numbers>

#include "model/effects/shared_parameters.h"

namespace hydro::model {

namespace {

class Cogging : public EffectOf<Cogging> {
 public:
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    x.load += Torque(x);
  }

  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    const double stored = Torque(x) * x.motor_speed;
    power->viscous -= stored;  // which contains it as part of the load
    power->effects_stored += stored;
  }

 private:
  template <class T>
  static T Torque(const Terms<T>& x) {
    using std::sin;
    return x.own[0] * sin(x.own[1] * x.motor_angle + x.own[2]);
  }
};

[[maybe_unused]] const bool kAdded =
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
                    .make = MakeEffect<Cogging>});

}  // namespace

}  // namespace hydro::model
