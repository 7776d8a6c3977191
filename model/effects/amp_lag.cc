// amp.lag: tau dT/dt + T = k_1 v. One state, T; the limit applies to T_p, which is T within +/- T_pmax.
// One switch: 0 T is within the limit, +1 and -1 T_p is at that limit.
#include <ceres/jet.h>

#include "model/effects/effect.h"

namespace hydro {

namespace {

class Lag : public EffectOf<Lag> {
 public:
  explicit Lag(double tau) : tau_(tau) {}

  int states() const override { return 1; }
  int switches() const override { return 1; }
  std::vector<std::string> StateNames() const override { return {"lagged_torque"}; }
  void Scales(double, double, double torque, double* scale) const override { scale[0] = torque; }

  template <class T>
  void OwnProperties(Terms<T>& x) const {
    const int limit = x.mode->effects[first_switch()];
    x.torque = limit == 0 ? x.state[first_state()] : T(limit * x.parameters->T_pmax);
  }

  template <class T>
  void OwnStates(Terms<T>& x, T* rate) const {
    rate[first_state()] = (x.parameters->k_1 * x.voltage - x.state[first_state()]) / tau_;
  }

  void Margins(const Terms<double>& x, double* margin) const override {
    const int limit = x.mode->effects[first_switch()];
    const double torque = x.state[first_state()];
    const double T_pmax = x.parameters->T_pmax;
    margin[kFirstEffectSwitch + first_switch()] =
        limit == 0 ? T_pmax - std::abs(torque) : limit * torque - T_pmax;
  }

  void Cross(int, const Terms<double>& x, double*, Mode* mode) const override {
    int8_t& limit = mode->effects[first_switch()];
    limit = limit != 0 ? 0 : (x.state[first_state()] > 0 ? 1 : -1);
  }

 private:
  double tau_;
};

}  // namespace

CatalogueEntry AmpLag();
CatalogueEntry AmpLag() {
  return {{"amp.lag",
           "the motor torque follows the voltage with a time constant",
           "tau dT/dt + T = k_1 v",
           "amp.delay, sensor.pressure_lag",
           {{"tau", "s", 0, kUnbounded, false, "time constant"}}},
          [](const EffectDescription& description, const Parameters&) -> std::unique_ptr<Effect> {
            return std::make_unique<Lag>(description.parameters.at("tau"));
          }};
}

}  // namespace hydro
