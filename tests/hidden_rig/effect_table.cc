#include "effect_table.h"

#include <cmath>
#include <stdexcept>

namespace hidden_rig {

const std::vector<EffectForm>& EffectForms() {
  // `plain`: where nothing else is said, what gives the case effect-plain its gap.
  static const std::vector<EffectForm> forms = {
      {"amp.lag", 5e-5, 0.03, 0.002,
       [](double s, Effects* e) -> TrueEffect {
         e->lag_tau = s;
         return {"amp.lag", {{"tau", s}}, ""};
       }},
      {"amp.delay", 2e-5, 0.02, 0.002,
       [](double s, Effects* e) -> TrueEffect {
         e->delay = s;
         return {"amp.delay", {{"delay", s}}, ""};
       }},
      {"motor.speed_torque_limit", 0.005, 10, 1.7,
       [](double s, Effects* e) -> TrueEffect {
         e->no_load_speed = 1000 / s;
         return {"motor.speed_torque_limit", {{"no_load_speed", e->no_load_speed}}, ""};
       }},
      {"motor.cogging", 0.01, 4, 0.8,
       [](double s, Effects* e) -> TrueEffect {
         e->cogging = s;
         return {"motor.cogging",
                 {{"amplitude", s}, {"periods", e->cogging_periods}, {"phase", e->cogging_phase}},
                 ""};
       }},
      {"pump.pressure_friction", 1e-6, 0.01, 1e-3,
       [](double s, Effects* e) -> TrueEffect {
         e->pressure_friction = s;
         return {"pump.pressure_friction", {{"f", s}}, ""};
       }},
      {"pump.stribeck", 1e-3, 1.5, 0.5,
       [](double s, Effects* e) -> TrueEffect {
         e->stribeck_excess = s;
         return {"pump.stribeck", {{"static_excess", s}, {"speed", e->stribeck_speed}}, ""};
       }},
      {"pump.friction_asymmetry", 1e-4, 2, 0.5,
       [](double s, Effects* e) -> TrueEffect {
         e->asymmetry_coulomb = s;
         e->asymmetry_viscous = 0.003 * s;
         return {"pump.friction_asymmetry", {{"coulomb", s}, {"viscous", e->asymmetry_viscous}}, ""};
       }},
      {"pump.quadratic_drag", 1e-7, 1e-3, 2e-5,
       [](double s, Effects* e) -> TrueEffect {
         e->quadratic_drag = s;
         return {"pump.quadratic_drag", {{"k", s}}, ""};
       }},
      {"pump.turbulent_leakage", 1e-6, 0.02, 5e-4,
       [](double s, Effects* e) -> TrueEffect {
         e->turbulent_leakage = s;
         return {"pump.turbulent_leakage", {{"k", s}}, ""};
       }},
      {"pump.flow_ripple", 1e-3, 0.5, 0.05,
       [](double s, Effects* e) -> TrueEffect {
         e->flow_ripple = s;
         return {"pump.flow_ripple", {{"amplitude", s}, {"periods", e->flow_ripple_periods}}, ""};
       }},
      {"fluid.entrained_air", 1e-6, 0.05, 0.003,
       [](double s, Effects* e) -> TrueEffect {
         e->air_fraction = s;
         return {"fluid.entrained_air", {{"air_fraction", s}}, ""};
       }},
      {"fluid.stiffening", 0.1, 200, 15,
       [](double s, Effects* e) -> TrueEffect {
         e->stiffening = s;
         return {"fluid.stiffening", {{"slope", s}}, ""};
       }},
      {"fluid.warming", 1e-3, 1.5, 0.2,
       [](double s, Effects* e) -> TrueEffect {
         e->warming = s;
         return {"fluid.warming", {{"rate", s}}, ""};
       }},
      {"line.wave", 1, 40, 8,
       [](double s, Effects* e) -> TrueEffect {
         e->wave_hz = 600 / s;
         e->wave_damping = std::fmin(0.004 * s, 0.08);
         return {
             "line.wave",
             {{"frequency", e->wave_hz}, {"volume_fraction", e->wave_fraction}, {"damping", e->wave_damping}},
             ""};
       }},
      {"valve.check", 0.1, 90, 20,
       [](double s, Effects* e) -> TrueEffect {
         e->check_cracking = s;
         e->check_conductance = std::fmin(3 / s, 1.0);
         return {"valve.check", {{"cracking", s}, {"conductance", e->check_conductance}}, ""};
       }},
      {"valve.relief", 1e-7, 0.1, 1e-4,
       [](double s, Effects* e) -> TrueEffect {
         e->relief_set = 750;
         e->relief_conductance = s;
         return {"valve.relief", {{"set", e->relief_set}, {"conductance", s}}, ""};
       }},
      {"accumulator.stiffness", 1, 20000, 1500,
       [](double s, Effects* e) -> TrueEffect {
         e->accumulator = s;
         return {"accumulator.stiffness", {{"stiffness", s}}, ""};
       }},
      {"actuator.seal_friction", 0.5, 600, 120,
       [](double s, Effects* e) -> TrueEffect {
         e->seal_coulomb = s;
         e->seal_viscous = 0.5 * s;
         return {"actuator.seal_friction", {{"coulomb", s}, {"viscous", e->seal_viscous}}, ""};
       }},
      {"arm.flexure", 0.005, 60, 8,
       [](double s, Effects* e) -> TrueEffect {
         e->flexure_stiffness = 1e6 / s;
         e->flexure_damping = 0.1 * std::sqrt(e->flexure_stiffness * 23.3);
         return {"arm.flexure", {{"stiffness", e->flexure_stiffness}, {"damping", e->flexure_damping}}, ""};
       }},
      {"sensor.pressure_lag", 1e-5, 0.05, 0.002,
       [](double s, Effects* e) -> TrueEffect {
         e->sensor_tau = s;
         return {"sensor.pressure_lag", {{"tau", s}}, ""};
       }},
      {"sensor.pressure_offset", 0.1, 90, 25,
       [](double s, Effects* e) -> TrueEffect {
         e->offset_p1 = s;
         e->offset_p2 = -0.6 * s;
         return {"sensor.pressure_offset", {{"p1", s}, {"p2", e->offset_p2}}, ""};
       }},
      {"sensor.pressure_gain", 1e-4, 0.4, 0.05,
       [](double s, Effects* e) -> TrueEffect {
         e->gain = s;
         return {"sensor.pressure_gain", {{"gain", s}}, ""};
       }},
      {"sensor.skew", 2e-5, 0.1, 0.004,
       [](double s, Effects* e) -> TrueEffect {
         e->skew = s;
         e->skew_channel = Channel::kP2;
         return {"sensor.skew", {{"delay", s}}, "p2"};
       }},
      {"sensor.sign", 1, 1, 1,
       [](double, Effects* e) -> TrueEffect {
         e->sign_channel = Channel::kMotorSpeed;
         return {"sensor.sign", {}, "motor_speed"};
       }},
  };
  return forms;
}

const EffectForm& FindEffect(const std::string& id) {
  for (const auto& form : EffectForms()) {
    if (form.id == id) return form;
  }
  throw std::runtime_error("no effect " + id);
}

const std::vector<BaseForm>& BaseForms() {
  static const std::vector<BaseForm> forms = {
      {"k_1", &Base::k_1},   {"T_pmax", &Base::T_pmax}, {"D", &Base::D},     {"J", &Base::J},
      {"b", &Base::b},       {"T_s", &Base::T_s},       {"f", &Base::f},     {"beta", &Base::beta},
      {"V_ms", &Base::V_ms}, {"c_E", &Base::c_E},       {"c_I", &Base::c_I}, {"p_3", &Base::p_3},
      {"k_2", &Base::k_2},   {"J_a", &Base::J_a},       {"mgl", &Base::mgl}};
  return forms;
}

const std::vector<OutsideForm>& OutsideForms() {
  static const std::vector<OutsideForm> forms = {
      {"a spring on the arm", "arm_torque", 1, 3000, &Outside::arm_spring},
      {"a torque on the pump that depends on the time of day", "pump_torque", 0.01, 4,
       &Outside::daily_torque},
      {"play between actuator and arm", "arm_torque", 1e-5, 0.02, &Outside::backlash},
      {"cross-port leakage that grows with the arm's angle", "flow_1", 1e-8, 1e-3,
       &Outside::leakage_position},
      {"the arm's centre of mass off its axis: gravity with a sine", "arm_torque", 1, 1500,
       &Outside::gravity_sine},
      {"a motor that saturates: torque per volt falls at high torque", "pump_torque", 0.005, 0.5,
       &Outside::torque_saturation},
      {"hoses that creep", "flow_2", 0.005, 2, &Outside::hose_creep},
      {"cushions near the ends of the arm's motion", "arm_torque", 10, 20000, &Outside::end_cushion},
      {"a motor whose torque fades while it is loaded", "pump_torque", 1e-3, 1.5, &Outside::torque_fade},
      {"a floor that shakes the arm", "arm_torque", 1, 3000, &Outside::floor_vibration},
  };
  return forms;
}

}  // namespace hidden_rig
