// line.wave: on each side, a line with inertia lies between the pump's volume and the actuator's.
//   pump side:      p_p' = -(beta/V_p) (q + Q), with q of eqs. (11), (12) at the pump's pressures and
//                   V_p = volume_fraction V_ms
//   line:           I Q' = p_p - p - R Q
//   actuator side:  volume V(alpha) - V_p, fed by Q instead of -q; transducers and one-way valves are here
// I is such that the two volumes resonate through the line at `frequency` at mid-stroke, and R such that this
// mode has the damping ratio `damping`:
//   I w^2 = beta (1/V_p + 1/(V_ms - V_p)),  R = 2 damping I w,  w = 2 pi frequency.
// States: p_p1, Q_1, p_p2, Q_2.

#include <numbers>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class Wave : public EffectOf<Wave> {
 public:
  int states() const override { return 4; }
  std::vector<std::string> StateNames() const override {
    return {"pump_p1", "line_flow_1", "pump_p2", "line_flow_2"};
  }
  template <class T>
  void OwnStart(const Terms<T>& x, T* state) const {
    const int i = first_state();
    state[i] = x.p1;
    state[i + 2] = x.p2;
    if (x.waves == nullptr) return;
    const Line<T> line(x);
    const T impedance = 2 * std::numbers::pi * x.own[0] * line.inertance;
    state[i] += x.waves[0];
    state[i + 1] += x.waves[1] / impedance;
    state[i + 2] += x.waves[2];
    state[i + 3] += x.waves[3] / impedance;
  }
  void Scales(const StateSizes& of, double* scale) const override {
    scale[0] = scale[2] = of.pressure;
    scale[1] = scale[3] = of.flow;
  }
  template <class T>
  T OwnFixedVolume(const ParametersOf<T>& base, const T* own) const {
    return own[1] * base.V_ms;
  }

  template <class T>
  void OwnProperties(Terms<T>& x) const {
    x.pump_p1 = x.state[first_state()];
    x.pump_p2 = x.state[first_state() + 2];
  }

  template <class T>
  void OwnStates(Terms<T>& x, T* rate) const {
    const int i = first_state();
    const Line<T> line(x);
    const T flow_1 = x.state[i + 1];
    const T flow_2 = x.state[i + 3];
    rate[i] = -x.beta_1 / line.pump_volume * (x.q_1 + flow_1);
    rate[i + 1] = (x.pump_p1 - x.p1 - line.resistance * flow_1) / line.inertance;
    rate[i + 2] = -x.beta_2 / line.pump_volume * (x.q_2 + flow_2);
    rate[i + 3] = (x.pump_p2 - x.p2 - line.resistance * flow_2) / line.inertance;
    x.q_1 = -flow_1;
    x.q_2 = -flow_2;
  }

  void AddPower(const Terms<double>& x, const double* rate, Power* power) const override {
    const int i = first_state();
    const Line<double> line(x);
    const double flow_1 = x.state[i + 1];
    const double flow_2 = x.state[i + 3];
    power->effects_stored += (x.pump_p1 - x.p_3) * line.pump_volume / x.beta_1 * rate[i] +
                             (x.pump_p2 - x.p_3) * line.pump_volume / x.beta_2 * rate[i + 2] +
                             line.inertance * (flow_1 * rate[i + 1] + flow_2 * rate[i + 3]);
    power->effects_dissipated += line.resistance * (flow_1 * flow_1 + flow_2 * flow_2);
  }

 private:
  template <class T>
  struct Line {
    explicit Line(const Terms<T>& x) {
      const ParametersOf<T>& base = *x.parameters;
      const T w = 2 * std::numbers::pi * x.own[0];
      pump_volume = x.own[1] * base.V_ms;
      inertance = base.beta * (1.0 / pump_volume + 1.0 / (base.V_ms - pump_volume)) / (w * w);
      resistance = 2.0 * x.own[2] * inertance * w;
    }
    T pump_volume, inertance, resistance;
  };
};

[[maybe_unused]] const bool kLineWaveAdded = AddToCatalogue(
    {.info = {.id = "line.wave",
              .summary = "pressure waves in the lines between pump and actuator",
              .equation = "a line with inertia between the pump's and the actuator's volume on each side; "
                          "the transducers sit at the actuator",
              .confused_with = "sensor.pressure_lag, pump.flow_ripple",
              .parameters = {{.name = "frequency",
                              .unit = "Hz",
                              .min_allowed = false,
                              .meaning = "resonance of the two volumes of one side through the line",
                              .starts = {0.01, 0.02, 0.04, 0.1, 0.25},
                              .scale = Scale::kRate,
                              .role = Role::kFrequency,
                              .example = 300},
                             {.name = "volume_fraction",
                              .unit = "1",
                              .max = 0.999,
                              .min_allowed = false,
                              .meaning = "part of V_ms that is at the pump",
                              .starts = {0.1, 0.35},
                              .example = 0.2},
                             {.name = "damping",
                              .unit = "1",
                              .meaning = "damping ratio of the resonance",
                              .starts = {0.03},
                              .example = 0.05}},
              // Behind an open bypass, the oil in a line acts as inertia and friction of the motor.
              .needs_oil = true},
     .make = MakeEffect<Wave>});

}  // namespace

}  // namespace hydro::model
