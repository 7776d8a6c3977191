// Models and conditions that several tests run.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/actuator.h"
#include "model/equations.h"
#include "model/simulation.h"
#include "tests/table1.h"

namespace hydro::testing {

inline ModelDescription Table1Model(std::vector<EffectDescription> effects = {}) {
  ModelDescription model;
  model.name = "Table 1";
  model.parameters = Table1();
  model.effects = std::move(effects);
  return model;
}

inline EffectDescription Stribeck(double static_excess, double speed) {
  return {"pump.stribeck", {{"static_excess", static_excess}, {"speed", speed}}, {}};
}
inline EffectDescription Wave(double frequency, double volume_fraction, double damping) {
  return {"line.wave",
          {{"frequency", frequency}, {"volume_fraction", volume_fraction}, {"damping", damping}},
          {}};
}
inline EffectDescription Lag(double tau) { return {"amp.lag", {{"tau", tau}}, {}}; }

inline ActuatorOptions Held(Shaft shaft, Integrator integrator = Integrator::kFast) {
  ActuatorOptions options;
  options.shaft = shaft;
  options.integrator = integrator;
  return options;
}

// Equations in motion, with the mode in sight.
struct Rig {
  Rig(const ModelDescription& model, const ActuatorOptions& options)
      : equations(model, options),
        simulation(MakeSimulation(&equations, options.integrator, options.initial_pressure,
                                  options.relative_tolerance)) {}
  Measurement Measure() const {
    return equations.Measure(simulation->now().time, simulation->now().state, simulation->history());
  }

  Equations equations;
  std::unique_ptr<Simulation> simulation;
};

inline std::string Name(Integrator integrator) {
  switch (integrator) {
    case Integrator::kAuto:
      return "Auto";
    case Integrator::kFast:
      return "Fast";
    case Integrator::kErk:
      return "Erk";
    case Integrator::kCvode:
      return "Cvode";
  }
  return "?";
}

inline constexpr Integrator kIntegrators[] = {Integrator::kAuto, Integrator::kFast, Integrator::kErk,
                                              Integrator::kCvode};

// Eq. (16) with the gains of the reference runs, following a +/-300 psi square wave of 10 Hz at 5 kHz.
inline double SquareWaveLoop(const Measurement& m, int tick) {
  const double reference = tick % 500 < 250 ? 300 : -300;
  return 0.134 * (reference - (m.p2 - m.p1) - 8.4 * m.motor_speed);
}

}  // namespace hydro::testing
