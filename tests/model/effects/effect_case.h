// What the tests of single effects share: models and rigs in which little but the effect acts.
#pragma once

#include <utility>
#include <vector>

#include "model/effects/effect.h"
#include "tests/model/model_case.h"

namespace hydro::testing {

inline constexpr double kStiffness = 247000 / 3.16;  // beta/V_ms, psi/in^3

// The pump sticks at equal pressures on both sides, and nothing leaks except through what the test adds.
inline model::ModelDescription Sealed(model::EffectDescription effect, double c_E = 0) {
  model::ModelDescription model = Table1Model({std::move(effect)});
  model.parameters.c_E = c_E;
  model.parameters.c_I = 0;
  return model;
}

inline model::ActuatorOptions HeldAt(double pressure,
                                     model::Integrator integrator = model::Integrator::kFast) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped, integrator);
  options.initial_pressure = pressure;
  return options;
}

inline model::ActuatorOptions Bypassed() {
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.bypass = true;
  return options;
}

inline model::Terms<double> TermsOf(const Rig& rig, double voltage) {
  double rate[model::kMaxStates];
  model::Terms<double> x;
  const model::Point& now = rig.simulation->now();
  rig.equations.Evaluate(now.time, voltage, rig.simulation->mode(), now.state, rate, &x);
  return x;
}

inline model::Terms<double> TermsAt(const model::Equations& equations, const std::vector<double>& state,
                                    double* rate) {
  model::Terms<double> x;
  equations.Evaluate(0, 0, model::Mode{}, state.data(), rate, &x);
  return x;
}

}  // namespace hydro::testing
