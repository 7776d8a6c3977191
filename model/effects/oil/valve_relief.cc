// valve.relief: flow conductance (p - set) out of a side above `set`, to the accumulator. The valves are at
// the actuator, as the one-way valves are. One switch for each side: 0 closed, 1 open.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class Relief : public EffectOf<Relief> {
 public:
  int switches() const override { return 2; }

  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    if (Open(x, 0)) x.valve_flow_1 += x.own[1] * (x.p1 - x.own[0]);
    if (Open(x, 1)) x.valve_flow_2 += x.own[1] * (x.p2 - x.own[0]);
  }

  template <class T>
  void OwnMargins(const Terms<T>& x, T* margin) const {
    T* own = margin + kFirstEffectSwitch + first_switch();
    own[0] = Open(x, 0) ? T(x.p1 - x.own[0]) : T(x.own[0] - x.p1);
    own[1] = Open(x, 1) ? T(x.p2 - x.own[0]) : T(x.own[0] - x.p2);
  }

  template <class T>
  void OwnCross(int which, const Terms<T>& /*x*/, T* /*state*/, Mode* mode) const {
    int8_t& position = mode->effects[first_switch() + which];
    position = position == 0 ? 1 : 0;
  }

  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    if (Open(x, 0)) power->effects_dissipated += x.own[1] * (x.p1 - x.own[0]) * (x.p1 - x.p_3);
    if (Open(x, 1)) power->effects_dissipated += x.own[1] * (x.p2 - x.own[0]) * (x.p2 - x.p_3);
  }

 private:
  template <class T>
  bool Open(const Terms<T>& x, int side) const {
    return x.mode->effects[first_switch() + side] != 0;
  }
};

[[maybe_unused]] const bool kValveReliefAdded =
    AddToCatalogue({.info = {.id = "valve.relief",
                             .summary = "relief valves from each side to the accumulator",
                             .equation = "flow conductance (p - set) out of a side above set",
                             .confused_with = "parameter c_E",
                             .parameters = {{.name = "set",
                                             .unit = "psi",
                                             .meaning = "pressure at which the valve opens",
                                             .starts = {0.3, 0.5, 0.7, 0.85, 0.95},
                                             .scale = Scale::kPressure,
                                             .example = 200},
                                            {.name = "conductance",
                                             .unit = "in^3/s/psi",
                                             .meaning = "flow per pressure above set",
                                             .example = 0.001}},
                             // Where it regulates, the pressure is constant and the flow is the remainder of
                             // the other flows.
                             .unseen_by_balances = true,
                             .needs_oil = true},
                    .make = MakeEffect<Relief>});

}  // namespace

}  // namespace hydro::model
