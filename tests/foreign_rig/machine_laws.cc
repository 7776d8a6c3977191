// What each part gives for a state: torques, losses, leakage, compliance, loads.
#include <algorithm>
#include <cmath>

#include "fluid.h"
#include "machine.h"
#include "pistons.h"

namespace foreign_rig {

namespace {

double Signed(double value, double power) { return std::copysign(std::pow(std::abs(value), power), value); }

}  // namespace

double Machine::SupplyPressure(const State& x) const {
  const Values& v = rig_.values;
  if (rig_.effects.accumulator_gas == 0) return v.supply_pressure;
  const double room =
      std::max(rig_.effects.accumulator_gas - x[kReturned], 0.05 * rig_.effects.accumulator_gas);
  return (v.supply_pressure + kAtmosphere) * std::pow(rig_.effects.accumulator_gas / room, 1.2) - kAtmosphere;
}

// Torque of the motor on the pump's shaft.
double Machine::Torque(const State& x, double torque) const {
  const Values& v = rig_.values;
  const Effects& e = rig_.effects;
  double limit = v.torque_limit;
  const double w = x[kOmega];
  if (e.back_emf_speed > 0 && torque * w > 0) {
    const double headroom = 1 - std::abs(w) / e.back_emf_speed;
    limit = std::min(limit, std::max(0.0, e.stall_ratio * v.torque_limit * headroom));
  }
  torque = std::clamp(torque, -limit, limit);
  const double part = torque / v.torque_limit;
  torque *= 1 - rig_.outside.iron_saturation * part * part;
  if (rig_.outside.motor_fade > 0) torque *= 1 - x[kFade];
  if (rig_.outside.slow_torque != 0)
    torque -= rig_.outside.slow_torque * std::sin(0.86 * (time() + day_.clock));
  torque += e.bias;
  if (e.cogging != 0) {
    const double turn = e.slots * x[kTheta] + e.cogging_phase;
    torque -= e.cogging * (std::sin(turn) + 0.2 * std::sin(2 * turn + 1) + 0.1 * std::sin(x[kTheta] + 2));
  }
  return torque;
}

// Force of the bristles in steady slip (Hess and Soom 1990 for its fall with speed).
double Machine::DryLimit(const State& x) const {
  const Values& v = rig_.values;
  const Effects& e = rig_.effects;
  double limit = v.dry_torque;
  if (e.static_excess != 0) {
    const double relative = x[kOmega] / e.stribeck_speed;
    limit *= 1 + e.static_excess / (1 + relative * relative);
  }
  const bool line = pipe_1_.present();
  limit += (v.pressure_friction + e.friction_by_pressure) *
           ((line ? x[kPump1] : x[kP1]) + (line ? x[kPump2] : x[kP2]));
  limit += x[kOmega] > 0 ? e.dry_asymmetry : -e.dry_asymmetry;
  if (rig_.rich.once_a_turn != 0)
    limit += rig_.rich.size * rig_.rich.once_a_turn * std::sin(x[kTheta] + rig_.rich.once_phase);
  return std::max(limit, 0.01 * v.dry_torque);
}

double Machine::PumpLosses(const State& x, double viscosity) const {
  const Effects& e = rig_.effects;
  const double w = x[kOmega];
  double loss = BristleForce(pump_bristles_, pump_bend_, w, DryLimit(x));
  loss += rig_.values.viscous_torque * viscosity * w + e.viscous_asymmetry * std::abs(w);
  if (e.churning != 0) loss += e.churning * Signed(w / 300, e.churning_power);
  if (rig_.outside.film_friction != 0)
    loss += rig_.outside.film_friction * std::tanh(w / 2) * std::sqrt(std::abs(w) / 100);
  return loss;
}

double Machine::Displacement(const State& x) const {
  const Effects& e = rig_.effects;
  double displacement = rig_.values.displacement;
  if (e.piston_ripple != 0)
    displacement *= 1 + e.piston_ripple / PulseAmplitude(e.pistons) * (PistonPulse(e.pistons, x[kTheta]) - 1);
  if (rig_.outside.case_stretch != 0)
    displacement *= 1 - rig_.outside.case_stretch * std::abs(x[kP2] - x[kP1]) / 1000;
  return displacement;
}

double Machine::CrossLeakage(const State& x, double dp, double viscosity) const {
  const Effects& e = rig_.effects;
  double flow = rig_.values.cross_leakage / viscosity * dp;
  if (e.orifice != 0) {
    const double transition = e.orifice_transition;
    flow += e.orifice * dp / std::sqrt(std::sqrt(dp * dp + transition * transition));
  }
  if (rig_.outside.position_leakage != 0) {
    const double off = x[kVane] / 0.1;
    flow += rig_.outside.position_leakage * off * off / (1 + 0.1 * off * off) * dp;
  }
  return flow;
}

Machine::Chamber Machine::ChamberOf(const State& x, int side) const {
  const Values& v = rig_.values;
  const Effects& e = rig_.effects;
  const double volume =
      v.mid_volume + (side == 1 ? -1 : 1) * v.vane_volume * x[kVane] - pump_volume_ - pipe_volume_;
  const double p = x[side == 1 ? kP1 : kP2];
  double compressibility = 1 / HoseModulus(v.bulk_modulus, e.hose_stiffening, e.hose_knee, p);
  if (e.air > 0) compressibility += AirCompressibility(x[side == 1 ? kAir1 : kAir2], p);
  return {volume, volume * compressibility};
}

// Torque that the arm's surroundings ask of the actuator.
double Machine::Load(const State& x) const {
  const Values& v = rig_.values;
  const Outside& o = rig_.outside;
  const double a = x[kArm];
  double load = v.arm_weight * std::cos(a) +
                (o.gravity_offset + rig_.rich.size * rig_.rich.gravity_offset) * std::sin(a);
  if (o.arm_spring != 0) load += o.arm_spring * a * (1 + a * a / 0.09);
  if (o.end_cushion != 0) {
    const double in = std::max(0.0, std::abs(a) - 0.08);
    load += o.end_cushion * std::copysign(in * in, a);
  }
  if (o.floor_shake != 0) {
    const double t = time() + day_.clock;
    load +=
        o.floor_shake * (std::sin(53 * t) + 0.7 * std::sin(81 * t + 1) + 0.5 * std::sin(37 * t + 2)) / 0.93;
  }
  return load;
}

// Through a soft shaft, with play and without pulling (Hunt and Crossley 1975), or with neither.
double Machine::ShaftTorque(const State& x) const {
  const Effects& e = rig_.effects;
  const double twist = x[kVane] - x[kArm];
  const double rate = x[kVaneRate] - x[kArmRate];
  if (rig_.outside.backlash == 0) return e.shaft_stiffness * twist + e.shaft_damping * rate;
  const double play = 0.5 * rig_.outside.backlash;
  const double pressed = std::abs(twist) - play;
  if (pressed <= 0) return 0;
  const double side = std::copysign(1.0, twist);
  const double force = e.shaft_stiffness * pressed * (1 + 20 * side * rate);
  return side * std::max(0.0, force);
}

}  // namespace foreign_rig
