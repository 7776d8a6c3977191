// valve.check: the one-way valve of each side opens at p3 - cracking and passes conductance (p3 - cracking -
// p). It replaces the ideal valve, so p may fall below p3. One switch for each side: 0 closed, 1 open.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class Check : public EffectOf<Check> {
 public:
  int switches() const override { return 2; }
  bool replaces_valves() const override { return true; }

  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    if (Open(x, 0)) x.valve_flow_1 -= x.own[1] * (x.p_3 - x.own[0] - x.p1);
    if (Open(x, 1)) x.valve_flow_2 -= x.own[1] * (x.p_3 - x.own[0] - x.p2);
  }

  template <class T>
  void OwnMargins(const Terms<T>& x, T* margin) const {
    T* own = margin + kFirstEffectSwitch + first_switch();
    const T opens = x.p_3 - x.own[0];
    own[0] = Open(x, 0) ? T(opens - x.p1) : T(x.p1 - opens);
    own[1] = Open(x, 1) ? T(opens - x.p2) : T(x.p2 - opens);
  }

  template <class T>
  void OwnCross(int which, const Terms<T>& /*x*/, T* /*state*/, Mode* mode) const {
    int8_t& position = mode->effects[first_switch() + which];
    position = position == 0 ? 1 : 0;
  }

  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    if (Open(x, 0)) power->effects_dissipated += x.own[1] * (x.p_3 - x.own[0] - x.p1) * (x.p_3 - x.p1);
    if (Open(x, 1)) power->effects_dissipated += x.own[1] * (x.p_3 - x.own[0] - x.p2) * (x.p_3 - x.p2);
  }

 private:
  template <class T>
  bool Open(const Terms<T>& x, int side) const {
    return x.mode->effects[first_switch() + side] != 0;
  }
};

[[maybe_unused]] const bool kValveCheckAdded = AddToCatalogue(
    {.info = {.id = "valve.check",
              .summary = "one-way valves that need a pressure to open and resist the flow",
              .equation =
                  "the one-way valve opens at p3 - cracking and passes conductance (p3 - cracking - p)",
              .confused_with = "parameter p3, accumulator.stiffness",
              .parameters = {{.name = "cracking",
                              .unit = "psi",
                              .meaning = "pressure below p3 at which the valve opens",
                              .starts = {0.1},
                              .scale = Scale::kCharge,
                              .example = 10},
                             {.name = "conductance",
                              .unit = "in^3/s/psi",
                              .meaning = "flow per pressure below that",
                              .starts = {30, 300},
                              .scale = Scale::kFlow,
                              .example = 0.001}},
              .needs_oil = true},
     .make = MakeEffect<Check>});

}  // namespace

}  // namespace hydro::model
