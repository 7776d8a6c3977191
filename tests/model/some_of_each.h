// One model effect of each kind, for tests that go through the catalogue.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/model/model_case.h"

namespace hydro::testing {

// Some of each effect of the catalogue but amp.delay, which remembers (tested below). The motor turns little
// within a period, so that differences see the slope.
inline const std::map<std::string, model::EffectDescription>& SomeOfEach() {
  static const std::map<std::string, model::EffectDescription> effects = [] {
    std::map<std::string, model::EffectDescription> by_id;
    for (const model::EffectDescription& effect : std::vector<model::EffectDescription>{
             {"accumulator.stiffness", {{"stiffness", 3e3}}, {}},
             {"actuator.seal_friction", {{"coulomb", 100}, {"viscous", 50}}, {}},
             Lag(2e-3),
             {"arm.flexure", {{"stiffness", 6e3}, {"damping", 60}}, {}},
             {"fluid.entrained_air", {{"air_fraction", 0.02}}, {}},
             {"fluid.stiffening", {{"slope", 20}}, {}},
             {"fluid.warming", {{"rate", 2}}, {}},
             {"motor.cogging", {{"amplitude", 2}, {"periods", 0.2}, {"phase", 0.4}}, {}},
             {"motor.speed_torque_limit", {{"no_load_speed", 300}}, {}},
             {"pump.flow_ripple", {{"amplitude", 0.1}, {"periods", 0.2}}, {}},
             {"pump.turbulent_leakage", {{"k", 1e-3}}, {}},
             {"sensor.pressure_lag", {{"tau", 3e-3}}, {}},
             {"sensor.sign", {}, {{"signal", "p1"}}},
             {"sensor.skew", {{"delay", 1e-3}}, {{"signal", "p2"}}},
             {"valve.check", {{"cracking", 10}, {"conductance", 1e-3}}, {}},
             {"valve.relief", {{"set", 200}, {"conductance", 1e-3}}, {}},
             Wave(300, 0.2, 0.05),
             {"pump.friction_asymmetry", {{"coulomb", 1}, {"viscous", 0.01}}, {}},
             {"pump.pressure_friction", {{"f", 0.001}}, {}},
             {"pump.quadratic_drag", {{"k", 1e-3}}, {}},
             Stribeck(0.5, 3),
             {"sensor.pressure_gain", {{"gain", 0.05}}, {}},
             {"sensor.pressure_offset", {{"p1", 3}, {"p2", -2}}, {}}}) {
      by_id[effect.id] = effect;
    }
    return by_id;
  }();
  return effects;
}

}  // namespace hydro::testing
