#include "catalogue.h"

#include <cmath>
#include <stdexcept>

#include "draw.h"
#include "fluid.h"

namespace foreign_rig {

const char* NameOf(Signal signal) {
  switch (signal) {
    case Signal::kMotorSpeed:
      return "motor_speed";
    case Signal::kArmAngle:
      return "arm_angle";
    case Signal::kP1:
      return "p1";
    case Signal::kP2:
      return "p2";
    case Signal::kNone:
      break;
  }
  return "";
}

namespace {

Truth Lag(double s, uint64_t, Rig* rig) {
  rig->effects.lag = s;
  return {"amp.lag", {{"tau", s}}, ""};
}
Truth Delay(double s, uint64_t, Rig* rig) {
  rig->effects.delay = s;
  return {"amp.delay", {{"delay", s}}, ""};
}
Truth SpeedTorqueLimit(double s, uint64_t seed, Rig* rig) {
  rig->effects.back_emf_speed = 900 / s;
  rig->effects.stall_ratio = Draw(seed, "stall").Between(1.0, 1.25);
  return {"motor.speed_torque_limit", {{"no_load_speed", 900 / s}}, ""};
}
Truth Cogging(double s, uint64_t seed, Rig* rig) {
  Draw draw(seed, "cogging");
  rig->effects.cogging = s;
  rig->effects.slots = 4 + 2 * draw.Index(6);
  rig->effects.cogging_phase = draw.Between(0, kTurn);
  return {"motor.cogging", {{"amplitude", s}, {"periods", static_cast<double>(rig->effects.slots)}}, ""};
}
Truth Bias(double s, uint64_t seed, Rig* rig) {
  rig->effects.bias = s * Draw(seed, "bias").Sign();
  return {"amp.bias", {{"bias", rig->effects.bias}}, ""};
}
Truth PressureFriction(double s, uint64_t, Rig* rig) {
  rig->effects.friction_by_pressure = s;
  return {"pump.pressure_friction", {{"f", s}}, ""};
}
Truth Stribeck(double s, uint64_t seed, Rig* rig) {
  Draw draw(seed, "stribeck");
  rig->effects.static_excess = s;
  rig->effects.stribeck_speed = draw.LogBetween(2, 9);
  rig->effects.bristle_give = draw.LogBetween(2e-4, 1.5e-3);
  return {"pump.stribeck", {{"static_excess", s}, {"speed", rig->effects.stribeck_speed}}, ""};
}
Truth Asymmetry(double s, uint64_t seed, Rig* rig) {
  Draw draw(seed, "asymmetry");
  rig->effects.dry_asymmetry = s * draw.Sign();
  rig->effects.viscous_asymmetry = s * 0.004 * draw.Between(0.5, 1.5) * draw.Sign();
  return {"pump.friction_asymmetry",
          {{"coulomb", rig->effects.dry_asymmetry}, {"viscous", rig->effects.viscous_asymmetry}},
          ""};
}
Truth Churning(double s, uint64_t seed, Rig* rig) {
  rig->effects.churning = s;
  rig->effects.churning_power = Draw(seed, "churning").Between(1.9, 2.2);
  return {"pump.quadratic_drag", {{"k", s / 9e4}}, ""};
}
Truth Orifice(double s, uint64_t seed, Rig* rig) {
  rig->effects.orifice = s;
  rig->effects.orifice_transition = Draw(seed, "orifice").LogBetween(10, 60);
  return {"pump.turbulent_leakage", {{"k", s}}, ""};
}
Truth Ripple(double s, uint64_t seed, Rig* rig) {
  constexpr int kPistons[] = {5, 7, 9, 11};
  rig->effects.piston_ripple = s;
  rig->effects.pistons = kPistons[Draw(seed, "ripple").Index(4)];
  return {"pump.flow_ripple", {{"amplitude", s}, {"periods", 2.0 * rig->effects.pistons}}, ""};
}
Truth Air(double s, uint64_t seed, Rig* rig) {
  rig->effects.air = s;
  rig->effects.air_dissolves = Draw(seed, "air").LogBetween(1, 20);
  return {"fluid.entrained_air", {{"air_fraction", s}}, ""};
}
Truth Stiffening(double s, uint64_t seed, Rig* rig) {
  rig->effects.hose_stiffening = s;
  rig->effects.hose_knee = Draw(seed, "hose").LogBetween(800, 3000);
  return {"fluid.stiffening", {{"slope", s}}, ""};
}
Truth Warming(double s, uint64_t seed, Rig* rig) {
  rig->effects.warming = s;
  rig->effects.warming_time = Draw(seed, "warming").LogBetween(8, 30);
  return {"fluid.warming", {{"rate", s}}, ""};
}
// The first resonance of the two volumes through the pipe: its inertia is delay times impedance.
Truth Line(double s, uint64_t seed, Rig* rig) {
  Draw draw(seed, "line");
  Effects& e = rig->effects;
  const double hz = 500 / s;
  e.line_part = draw.Between(0.25, 0.45);
  const double pump = 0.8 * e.line_part;
  const double pipe = 0.2 * e.line_part;
  const double other = 1 - e.line_part;
  // I w^2 = beta (1/V_p + 1/V_a) with I = Z T = T^2 beta/V_pipe; half of the pipe counts with each side.
  const double square = pipe * (1 / (pump + 0.5 * pipe) + 1 / (other + 0.5 * pipe));
  e.line_delay = std::sqrt(square) / (kTurn * hz);
  const double damping = draw.Between(0.02, 0.06);
  e.line_loss = 2 * damping * kTurn * hz * e.line_delay;  // R = 2 damping I w = loss Z
  return {"line.wave", {{"frequency", hz}, {"volume_fraction", pump + 0.5 * pipe}}, ""};
}
Truth Check(double s, uint64_t seed, Rig* rig) {
  rig->effects.check_cracking = s;
  rig->effects.check_flow = Draw(seed, "check").LogBetween(0.2, 0.6);
  return {"valve.check", {{"cracking", s}}, ""};
}
Truth Relief(double s, uint64_t seed, Rig* rig) {
  rig->effects.relief_set = Draw(seed, "relief").Between(450, 750);
  rig->effects.relief_flow = s;
  return {"valve.relief", {{"set", rig->effects.relief_set}}, ""};
}
Truth Accumulator(double s, uint64_t, Rig* rig) {
  rig->effects.accumulator_gas = 1.2 * (rig->values.supply_pressure + kAtmosphere) / s;
  return {"accumulator.stiffness", {{"stiffness", s}}, ""};
}
Truth Seal(double s, uint64_t seed, Rig* rig) {
  rig->effects.seal_dry = s;
  rig->effects.seal_viscous = s * Draw(seed, "seal").Between(0.2, 1.0);
  return {"actuator.seal_friction", {{"coulomb", s}, {"viscous", rig->effects.seal_viscous}}, ""};
}
Truth Flexure(double s, uint64_t seed, Rig* rig) {
  Effects& e = rig->effects;
  e.shaft_stiffness = 1e6 / s;
  e.shaft_damping =
      2 * Draw(seed, "flexure").Between(0.03, 0.08) * std::sqrt(e.shaft_stiffness * rig->values.arm_inertia);
  return {"arm.flexure", {{"stiffness", e.shaft_stiffness}, {"damping", e.shaft_damping}}, ""};
}
Truth PressureLag(double s, uint64_t, Rig* rig) {
  rig->effects.pressure_lag = s;
  return {"sensor.pressure_lag", {{"tau", s}}, ""};
}
Truth Offset(double s, uint64_t seed, Rig* rig) {
  Draw draw(seed, "offset");
  rig->effects.offset_1 = s * draw.Sign();
  rig->effects.offset_2 = s * draw.Between(-1, 1);
  return {"sensor.pressure_offset", {{"p1", rig->effects.offset_1}, {"p2", rig->effects.offset_2}}, ""};
}
Truth Gain(double s, uint64_t seed, Rig* rig) {
  rig->effects.gain = s * Draw(seed, "gain").Sign();
  return {"sensor.pressure_gain", {{"gain", rig->effects.gain}}, ""};
}
Truth Drift(double s, uint64_t seed, Rig* rig) {
  Draw draw(seed, "drift");
  rig->effects.drift_1 = s * draw.Sign();
  rig->effects.drift_2 = s * draw.Between(-1, 1);
  return {"sensor.pressure_drift", {{"p1", rig->effects.drift_1}, {"p2", rig->effects.drift_2}}, ""};
}
Truth Skew(double s, uint64_t seed, Rig* rig) {
  constexpr Signal kLate[] = {Signal::kP1, Signal::kP2, Signal::kMotorSpeed};
  rig->effects.skew = s;
  rig->effects.skewed = kLate[Draw(seed, "skew").Index(3)];
  return {"sensor.skew", {{"delay", s}}, NameOf(rig->effects.skewed)};
}
Truth Inverted(double, uint64_t seed, Rig* rig) {
  constexpr Signal kWrong[] = {Signal::kArmAngle, Signal::kP1, Signal::kP2, Signal::kMotorSpeed};
  rig->effects.inverted = kWrong[Draw(seed, "inverted").Index(4)];
  return {"sensor.sign", {}, NameOf(rig->effects.inverted)};
}

}  // namespace

const std::vector<EffectForm>& EffectForms() {
  static const std::vector<EffectForm> forms = {
      {"amp.lag", "two stages, three quarters and a quarter", 1e-4, 0.03, 500, Lag},
      {"amp.delay", "as the catalogue's, from a running start", 5e-5, 0.02, 500, Delay},
      {"motor.speed_torque_limit", "a supply that could drive more than the limit at rest", 0.3, 6, 200,
       SpeedTorqueLimit},
      {"motor.cogging", "three harmonics", 0.02, 6, 500, Cogging},
      {"amp.bias", "as the catalogue's", 0.005, 3, 200, Bias},
      {"pump.pressure_friction", "carried by bristles", 1e-5, 0.01, 200, PressureFriction},
      {"pump.stribeck", "elasto-plastic bristles, falling as 1/(1 + (w/w_s)^2)", 0.01, 2.5, 200, Stribeck},
      {"pump.friction_asymmetry", "carried by bristles", 0.01, 3, 200, Asymmetry},
      {"pump.quadratic_drag", "a power of 1.9 to 2.2", 0.02, 12, 200, Churning},
      {"pump.turbulent_leakage", "an orifice that is laminar at low pressure", 1e-5, 0.02, 200, Orifice},
      {"pump.flow_ripple", "half sines of real pistons, from any angle", 2e-4, 0.3, 1000, Ripple},
      {"fluid.entrained_air", "isothermal, dissolves by Henry's law with a time constant", 1e-5, 0.04, 200,
       Air},
      {"fluid.stiffening", "a hose that stiffens up to a knee", 1, 400, 200, Stiffening},
      {"fluid.warming", "Vogel's viscosity, towards an end temperature", 0.002, 0.6, 200, Warming},
      {"line.wave", "characteristics, friction that grows with frequency", 1, 25, 1000, Line},
      {"valve.check", "a poppet with dynamics and square-root flow", 1, 90, 200, Check},
      {"valve.relief", "a poppet with dynamics and square-root flow", 1e-5, 0.5, 200, Relief},
      {"accumulator.stiffness", "gas, polytropic", 5, 20000, 200, Accumulator},
      {"actuator.seal_friction", "carried by bristles", 0.5, 500, 200, Seal},
      {"arm.flexure", "the vane has inertia of its own", 0.05, 60, 500, Flexure},
      {"sensor.pressure_lag", "two stages", 1e-4, 0.03, 500, PressureLag},
      {"sensor.pressure_offset", "as the catalogue's", 0.1, 90, 200, Offset},
      {"sensor.pressure_gain", "as the catalogue's", 1e-4, 0.4, 200, Gain},
      {"sensor.pressure_drift", "slows down over 20 s", 0.02, 30, 200, Drift},
      {"sensor.skew", "as the catalogue's", 1e-4, 0.05, 500, Skew},
      {"sensor.sign", "as the catalogue's", 1, 1, 200, Inverted},
  };
  return forms;
}

const EffectForm& FindEffect(const std::string& id) {
  for (const EffectForm& form : EffectForms()) {
    if (form.id == id) return form;
  }
  throw std::runtime_error("no effect " + id);
}

const std::vector<OutsideForm>& OutsideForms() {
  static const std::vector<OutsideForm> forms = {
      {"play between actuator and arm, with impacts", "arm_torque", "", 1e-5, 0.03, &Outside::backlash},
      {"a spring on the arm that hardens", "arm_torque", "arm_angle", 1, 4000, &Outside::arm_spring},
      {"iron that saturates", "pump_torque", "voltage", 0.003, 0.6, &Outside::iron_saturation},
      {"leakage past a worn place of the actuator", "flow_1", "arm_angle, dp", 1e-8, 3e-3,
       &Outside::position_leakage},
      {"hoses that creep", "flow_2", "", 0.003, 2, &Outside::hose_creep},
      {"a centre of mass off the arm's axis", "arm_torque", "arm_angle", 1, 2500, &Outside::gravity_offset},
      {"a film of oil: friction as the root of speed", "pump_torque", "motor_speed", 0.01, 8,
       &Outside::film_friction, "pump.shear_thinning"},
      {"a floor that shakes", "arm_torque", "", 1, 3000, &Outside::floor_shake},
      {"cushions near the ends", "arm_torque", "arm_angle", 10, 300000, &Outside::end_cushion},
      {"a case that stretches", "pump_torque", "dp", 5e-4, 0.4, &Outside::case_stretch},
      {"a motor that fades while it is loaded", "pump_torque", "", 1e-3, 3, &Outside::motor_fade},
      {"a torque on the pump that comes and goes slowly", "pump_torque", "", 0.01, 4, &Outside::slow_torque},
  };
  return forms;
}

}  // namespace foreign_rig
