// An accumulator whose pressure changes with the volume that it takes in, for the effects that define its
// stiffness. It adds one state: p3, which starts at the base parameter p_3.
//
// An open ideal valve holds its side at the changing p3 and passes the flow that this needs,
//   u = (V/beta) p3' + flow out of the side = (V/beta)(p3' - free rate),
// so the equation p3' = stiffness (flow into the accumulator - sum of u) is linear in p3' and is solved for
// it.
#pragma once

#include "model/effects/effect.h"

namespace hydro::model {

// Law::Stiffness(x, p_3): psi/in^3, the rise of pressure per returned volume.
template <class Law>
class Accumulator : public EffectOf<Accumulator<Law>> {
 public:
  using EffectOf<Accumulator<Law>>::first_state;

  int states() const override { return 1; }
  int p_3_state() const override { return first_state(); }
  std::vector<std::string> StateNames() const override { return {"p3"}; }
  void Scales(const StateSizes& of, double* scale) const override { scale[0] = of.pressure; }

  template <class T>
  void OwnStart(const Terms<T>& x, T* state) const {
    const T p_3 = x.parameters->p_3;
    state[first_state()] = p_3;
    if (x.returned != nullptr) state[first_state()] += Law::Stiffness(x, p_3) * *x.returned;
  }

  template <class T>
  void OwnProperties(Terms<T>& x) const {
    x.p_3 = x.state[first_state()];
  }

  template <class T>
  void OwnBalances(Terms<T>& x, T* rate) const {
    T flow = x.outer_flow_1 + x.outer_flow_2 + (x.valve_flow_1 + x.valve_flow_2);
    T held = T(0.0);  // in^3/psi, compliance of the sides that are held at p3
    const auto hold = [&](const T& compliance, const T& free_rate) {
      held += compliance;
      flow += compliance * free_rate;
    };
    const bool open_2 = x.bypass ? x.mode->valve_1 != 0 : x.mode->valve_2 != 0;
    if (x.mode->valve_1 != 0) hold(x.V_1 / x.beta_1, x.free_rate_1);
    if (open_2) hold(x.V_2 / x.beta_2, x.free_rate_2);
    const T stiffness = Law::Stiffness(x, x.state[first_state()]);
    x.p_3_rate = stiffness * flow / (1.0 + stiffness * held);
    rate[first_state()] = x.p_3_rate;
  }
};

}  // namespace hydro::model
