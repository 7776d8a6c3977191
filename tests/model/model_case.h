// Models and conditions that several tests run.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/actuator.h"
#include "model/equations/equations.h"
#include "model/integrate/simulation.h"
#include "model/terms/model_error.h"
#include "tests/table1.h"

namespace hydro::testing {

inline model::ModelDescription Table1Model(std::vector<model::EffectDescription> effects = {}) {
  model::ModelDescription model;
  model.name = "Table 1";
  model.parameters = Table1();
  model.effects = std::move(effects);
  return model;
}

inline model::EffectDescription Stribeck(double static_excess, double speed) {
  return {"pump.stribeck", {{"static_excess", static_excess}, {"speed", speed}}, {}};
}
inline model::EffectDescription Wave(double frequency, double volume_fraction, double damping) {
  return {"line.wave",
          {{"frequency", frequency}, {"volume_fraction", volume_fraction}, {"damping", damping}},
          {}};
}
inline model::EffectDescription Lag(double tau) { return {"amp.lag", {{"tau", tau}}, {}}; }
inline const model::EffectDescription kFlexure = {"arm.flexure", {{"stiffness", 60000}, {"damping", 60}}, {}};

// What the model says when `act` is refused; empty where it is not.
inline std::string RefusalOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const model::ModelError& error) {
    return error.what();
  }
  return "";
}

inline model::ActuatorOptions Held(model::Shaft shaft,
                                   model::Integrator integrator = model::Integrator::kFast) {
  model::ActuatorOptions options;
  options.shaft = shaft;
  options.integrator = integrator;
  return options;
}

// Equations in motion, with a visible mode.
struct Rig {
  Rig(const model::ModelDescription& model, const model::ActuatorOptions& options)
      : equations(model, options),
        simulation(model::MakeSimulation(&equations, options.integrator, options.initial_pressure,
                                         options.relative_tolerance)) {}
  model::Measurement Measure() const {
    return equations.Measure(simulation->now().time, simulation->now().state, simulation->history());
  }

  model::Equations equations;
  std::unique_ptr<model::Simulation> simulation;
};

inline std::string Name(model::Integrator integrator) {
  switch (integrator) {
    case model::Integrator::kAuto:
      return "Auto";
    case model::Integrator::kFast:
      return "Fast";
    case model::Integrator::kErk:
      return "Erk";
    case model::Integrator::kCvode:
      return "Cvode";
  }
  return "?";
}

inline constexpr model::Integrator kIntegrators[] = {model::Integrator::kAuto, model::Integrator::kFast,
                                                     model::Integrator::kErk, model::Integrator::kCvode};

// Eq. (16) with the gains of the reference runs, following a +/-300 psi square wave of 10 Hz at 5 kHz.
inline double SquareWaveLoop(const model::Measurement& m, int tick) {
  const double reference = tick % 500 < 250 ? 300 : -300;
  return 0.134 * (reference - (m.p2 - m.p1) - 8.4 * m.motor_speed);
}

}  // namespace hydro::testing
