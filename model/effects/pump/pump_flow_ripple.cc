// pump.flow_ripple: D (1 + amplitude cos(periods theta)) in flow and torque, because the pistons deliver in
// turn.

#include <cmath>

#include "model/effects/shared_parameters.h"

namespace hydro::model {

namespace {

class FlowRipple : public EffectOf<FlowRipple> {
 public:
  template <class T>
  void OwnProperties(Terms<T>& x) const {
    using std::cos;
    x.D *= 1.0 + x.own[0] * cos(x.own[1] * x.motor_angle);
  }
};

[[maybe_unused]] const bool kPumpFlowRippleAdded = AddToCatalogue(
    {.info = {.id = "pump.flow_ripple",
              .summary = "the pump's displacement varies over a revolution",
              .equation = "D (1 + amplitude cos(periods theta)) in flow and torque",
              .confused_with = "motor.cogging, line.wave",
              .parameters = {{.name = "amplitude",
                              .unit = "1",
                              .min = -1,
                              .max = 1,
                              .meaning = "largest change of D over D; negative: least D at theta = 0",
                              .role = Role::kDisplacementWave,
                              .example = 0.1},
                             PeriodsPerRevolution(9)},
              .needs_oil = true},
     .make = MakeEffect<FlowRipple>});

}  // namespace

}  // namespace hydro::model
