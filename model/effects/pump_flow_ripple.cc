// pump.flow_ripple: D (1 + amplitude cos(periods theta)) in flow and torque: the pistons' displacement in
// turn.

#include <cmath>

#include "model/effects/effect.h"

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

}  // namespace

CatalogueEntry PumpFlowRipple();
CatalogueEntry PumpFlowRipple() {
  return {
      {"pump.flow_ripple",
       "the pump's displacement varies over a revolution",
       "D (1 + amplitude cos(periods theta)) in flow and torque",
       "motor.cogging, line.wave",
       {{"amplitude", "1", -1, 1, true, "largest change of D over D; negative: least D at theta = 0"},
        {"periods", "1/rev", 0, kUnbounded, false, "periods in one revolution", false, {}, PeriodsTried()}}},
      MakeEffect<FlowRipple>};
}

}  // namespace hydro::model
