// amp.lag: tau dT/dt + T = k_1 v. One state, T; the limit applies to T_p, which is T within +/- T_pmax.
// One switch: 0, T is within the limit; +1 and -1, T_p is at that limit.

#include "model/effects/shared_parameters.h"

namespace hydro::model {

namespace {

class Lag : public EffectOf<Lag> {
 public:
  int states() const override { return 1; }
  int switches() const override { return 1; }
  std::vector<std::string> StateNames() const override { return {"lagged_torque"}; }
  void Scales(const StateSizes& of, double* scale) const override { scale[0] = of.torque; }

  template <class T>
  void OwnProperties(Terms<T>& x) const {
    const int limit = x.mode->effects[first_switch()];
    x.torque = limit == 0 ? x.state[first_state()] : T(static_cast<double>(limit) * x.parameters->T_pmax);
  }

  template <class T>
  void OwnStates(Terms<T>& x, T* rate) const {
    rate[first_state()] = (x.parameters->k_1 * x.voltage - x.state[first_state()]) / x.own[0];
  }

  template <class T>
  void OwnMargins(const Terms<T>& x, T* margin) const {
    using std::abs;
    const int limit = x.mode->effects[first_switch()];
    const T& torque = x.state[first_state()];
    const T& T_pmax = x.parameters->T_pmax;
    margin[kFirstEffectSwitch + first_switch()] =
        limit == 0 ? T(T_pmax - abs(torque)) : T(static_cast<double>(limit) * torque - T_pmax);
  }

  template <class T>
  void OwnCross(int /*which*/, const Terms<T>& x, T* /*state*/, Mode* mode) const {
    int8_t& limit = mode->effects[first_switch()];
    limit = limit != 0 ? 0 : (x.state[first_state()] > T(0.0) ? 1 : -1);
  }
};

[[maybe_unused]] const bool kAmpLagAdded =
    AddToCatalogue({.info = {.id = "amp.lag",
                             .summary = "the motor torque follows the voltage with a time constant",
                             .equation = "tau dT/dt + T = k_1 v",
                             .confused_with = "amp.delay, sensor.pressure_lag",
                             .parameters = {TimeConstant(0.002)}},
                    .make = MakeEffect<Lag>});

}  // namespace

}  // namespace hydro::model
