// line.wave: on each side a line with inertia lies between the pump's volume and the actuator's.
//   pump side      p_p' = -(beta/V_p) (q + Q), with q of eqs. (11), (12) at the pump's pressures, V_p =
//   volume_fraction V_ms line           I Q' = p_p - p - R Q actuator side  volume V(alpha) - V_p, fed by Q
//   in the place of -q; transducers and one-way valves are there
// I makes the two volumes at mid-stroke resonate through the line at `frequency`, and R gives that mode
// `damping`:
//   I w^2 = beta (1/V_p + 1/(V_ms - V_p)),  R = 2 damping I w,  w = 2 pi frequency.
// States: p_p1, Q_1, p_p2, Q_2.
#include <ceres/jet.h>

#include <cmath>
#include <numbers>

#include "model/effects/effect.h"

namespace hydro {

namespace {

class Wave : public EffectOf<Wave> {
 public:
  Wave(double frequency, double volume_fraction, double damping, const Parameters& base)
      : pump_volume_(volume_fraction * base.V_ms) {
    const double w = 2 * std::numbers::pi * frequency;
    inertance_ = base.beta * (1 / pump_volume_ + 1 / (base.V_ms - pump_volume_)) / (w * w);
    resistance_ = 2 * damping * inertance_ * w;
  }

  int states() const override { return 4; }
  std::vector<std::string> StateNames() const override {
    return {"pump_p1", "line_flow_1", "pump_p2", "line_flow_2"};
  }
  void Start(const Terms<double>& x, double* state) const override {
    state[first_state()] = x.p1;
    state[first_state() + 2] = x.p2;
  }
  void Scales(double pressure, double flow, double, double* scale) const override {
    scale[0] = scale[2] = pressure;
    scale[1] = scale[3] = flow;
  }
  double FixedVolume(const Parameters&) const override { return pump_volume_; }

  template <class T>
  void OwnProperties(Terms<T>& x) const {
    x.pump_p1 = x.state[first_state()];
    x.pump_p2 = x.state[first_state() + 2];
  }

  template <class T>
  void OwnStates(Terms<T>& x, T* rate) const {
    const int i = first_state();
    const T flow_1 = x.state[i + 1];
    const T flow_2 = x.state[i + 3];
    rate[i] = -x.beta_1 / pump_volume_ * (x.q_1 + flow_1);
    rate[i + 1] = (x.pump_p1 - x.p1 - resistance_ * flow_1) / inertance_;
    rate[i + 2] = -x.beta_2 / pump_volume_ * (x.q_2 + flow_2);
    rate[i + 3] = (x.pump_p2 - x.p2 - resistance_ * flow_2) / inertance_;
    x.q_1 = -flow_1;
    x.q_2 = -flow_2;
  }

  void AddPower(const Terms<double>& x, const double* rate, Power* power) const override {
    const int i = first_state();
    const double flow_1 = x.state[i + 1];
    const double flow_2 = x.state[i + 3];
    power->effects_stored += (x.pump_p1 - x.p_3) * pump_volume_ / x.beta_1 * rate[i] +
                             (x.pump_p2 - x.p_3) * pump_volume_ / x.beta_2 * rate[i + 2] +
                             inertance_ * (flow_1 * rate[i + 1] + flow_2 * rate[i + 3]);
    power->effects_dissipated += resistance_ * (flow_1 * flow_1 + flow_2 * flow_2);
  }

 private:
  double pump_volume_;
  double inertance_;
  double resistance_;
};

}  // namespace

CatalogueEntry LineWave();
CatalogueEntry LineWave() {
  return {{"line.wave",
           "pressure waves in the lines between pump and actuator",
           "a line with inertia between the pump's and the actuator's volume on each side; the transducers "
           "sit at the "
           "actuator",
           "sensor.pressure_lag, pump.flow_ripple",
           {{"frequency", "Hz", 0, kUnbounded, false,
             "resonance of the two volumes of one side through the line"},
            {"volume_fraction", "1", 0, 0.999, false, "part of V_ms that is at the pump"},
            {"damping", "1", 0, kUnbounded, true, "damping ratio of the resonance"}}},
          [](const EffectDescription& description, const Parameters& base) -> std::unique_ptr<Effect> {
            const auto& p = description.parameters;
            return std::make_unique<Wave>(p.at("frequency"), p.at("volume_fraction"), p.at("damping"), base);
          }};
}

}  // namespace hydro
