#include "machine.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fluid.h"
#include "pistons.h"

namespace foreign_rig {

namespace {

constexpr double kPumpGive = 1e-5;      // rad that bristles bend where no richer form is asked for
constexpr double kSealGive = 5e-6;      // rad
constexpr double kVaneShare = 0.02;     // of the arm's inertia that is on the vane's side of a soft shaft
constexpr double kCreepTime = 0.12;     // s
constexpr double kAllDissolved = 4000;  // psi
constexpr double kLagFirst = 0.75;      // of a lag, in its first stage
constexpr double kPlayStiffness = 3e6;  // in-lbf/rad where nothing else is said

double Signed(double value, double power) { return std::copysign(std::pow(std::abs(value), power), value); }

// The smaller of two lags that add up has a fifth of a step at least: it is then stable.
double Stage(double lag, double part) { return std::max(lag * part, 2 * kStep); }

}  // namespace

Machine::Machine(const Rig& rig, const Day& day) : rig_(rig), day_(day) {
  Values& v = rig_.values;
  Effects& e = rig_.effects;
  v.dry_torque *= day.friction * (1 + rig_.rich.size * rig_.rich.daily_friction * day.friction_draw);
  v.arm_weight *= 1 + day.payload;
  v.arm_inertia *= 1 + day.payload;
  v.supply_pressure += day.supply;
  vane_inertia_ = kVaneShare * v.arm_inertia;
  if (rig_.outside.backlash > 0 && e.shaft_stiffness == 0) e.shaft_stiffness = kPlayStiffness;

  const double give = kPumpGive + rig_.rich.size * rig_.rich.bristle_give + e.bristle_give;
  pump_bristles_ = {v.dry_torque / give, 0, 0.05, 0.6};
  pump_bristles_.damping = std::sqrt(pump_bristles_.stiffness * v.rotor_inertia);
  if (e.seal_dry > 0) {
    const double inertia = joint() ? vane_inertia_ : v.arm_inertia;
    seal_bristles_ = {e.seal_dry / kSealGive, 0, 2e-4, 0.5};
    seal_bristles_.damping = std::sqrt(seal_bristles_.stiffness * inertia);
  }
  check_ = {e.check_cracking, 40, e.check_flow, 0.0015};
  relief_ = {e.relief_set, 250, e.relief_flow, 0.002};
  if (e.line_delay > 0) {
    // The pipe holds a fifth of what is not at the actuator; its impedance follows from volume and delay.
    pipe_volume_ = 0.2 * e.line_part * v.mid_volume;
    pump_volume_ = 0.8 * e.line_part * v.mid_volume;
    const double impedance = e.line_delay * v.bulk_modulus / pipe_volume_;
    pipe_1_ = pipe_2_ = Pipe(e.line_delay, impedance, e.line_loss, kStep);
  }
  commands_.assign(static_cast<size_t>(std::lround(e.delay / kStep)), 0.0);
  late_.assign(static_cast<size_t>(std::lround(e.skew / kStep)), 0.0);

  x_[kTheta] = day.shaft_angle;
  x_[kVane] = x_[kArm] = day.arm_angle;
  x_[kP1] = v.supply_pressure + std::max(0.0, day.pressure_1);
  x_[kP2] = v.supply_pressure + std::max(0.0, day.pressure_2);
  if (!day.clamped) {
    const double load = Load(x_) / v.arm_torque;
    x_[load > 0 ? kP2 : kP1] = x_[load > 0 ? kP1 : kP2] + std::abs(load);
    if (joint())
      x_[kVane] += load * v.arm_torque / e.shaft_stiffness + std::copysign(0.5 * rig_.outside.backlash, load);
  }
  if (day.bypass) x_[kP1] = x_[kP2] = 0.5 * (x_[kP1] + x_[kP2]);
  x_[kPump1] = x_[kCreep1] = x_[kSense1a] = x_[kSense1b] = x_[kP1];
  x_[kPump2] = x_[kCreep2] = x_[kSense2a] = x_[kSense2b] = x_[kP2];
  if (pipe_1_.present()) {
    pipe_1_.Fill(x_[kP1]);
    pipe_2_.Fill(x_[kP2]);
  }
  x_[kCelsius] = day.celsius;
  x_[kAir1] = FreeAir(e.air, x_[kP1], kAllDissolved);
  x_[kAir2] = FreeAir(e.air, x_[kP2], kAllDissolved);
  // The pump's bristles hold what the pressures push.
  const double full = v.dry_torque / pump_bristles_.stiffness;
  pump_bend_ = std::clamp(-v.displacement * (x_[kP2] - x_[kP1]) / pump_bristles_.stiffness, -full, full);
  if (!late_.empty()) std::fill(late_.begin(), late_.end(), SkewedNow());
}

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

// Air goes into solution and comes out of it late; what it gains in volume presses on the oil.
void Machine::AirRates(const State& x, int side, double volume, double* rate, double* flow) const {
  const double p = x[side == 1 ? kP1 : kP2];
  const double absolute = std::max(p, -0.9 * kAtmosphere) + kAtmosphere;
  const double goal = FreeAir(rig_.effects.air, p, kAllDissolved);
  *rate = (goal - x[side == 1 ? kAir1 : kAir2]) / rig_.effects.air_dissolves;
  *flow += volume * kAtmosphere / absolute * *rate;
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

void Machine::ArmRates(const State& x, State& rate) const {
  rate[kVane] = rate[kVaneRate] = rate[kArm] = rate[kArmRate] = 0;
  if (day_.clamped) return;
  const Values& v = rig_.values;
  const Effects& e = rig_.effects;
  double vane = v.arm_torque * (x[kP2] - x[kP1]);
  if (e.seal_dry > 0 || e.seal_viscous > 0) {
    vane -= e.seal_viscous * x[kVaneRate];
    if (e.seal_dry > 0) vane -= BristleForce(seal_bristles_, seal_bend_, x[kVaneRate], e.seal_dry);
  }
  rate[kVane] = x[kVaneRate];
  rate[kArm] = x[kArmRate];
  if (joint()) {
    const double through = ShaftTorque(x);
    rate[kVaneRate] = (vane - through) / vane_inertia_;
    rate[kArmRate] = (through - Load(x)) / (v.arm_inertia - vane_inertia_);
  } else {
    rate[kVaneRate] = rate[kArmRate] = (vane - Load(x)) / v.arm_inertia;
  }
}

void Machine::Rates(const State& x, State& rate) const {
  const Values& v = rig_.values;
  const Effects& e = rig_.effects;
  const bool line = pipe_1_.present();
  const double pump_1 = line ? x[kPump1] : x[kP1];
  const double pump_2 = line ? x[kPump2] : x[kP2];
  const double viscosity = x[kCelsius] == 40 ? 1 : RelativeViscosity(x[kCelsius]);
  const double supply = SupplyPressure(x);

  // Drive.
  double torque = v.torque_per_volt * volts_;
  rate[kDrive1] = rate[kDrive2] = 0;
  if (e.lag > 0) {
    rate[kDrive1] = (torque - x[kDrive1]) / Stage(e.lag, kLagFirst);
    rate[kDrive2] = (x[kDrive1] - x[kDrive2]) / Stage(e.lag, 1 - kLagFirst);
    torque = x[kDrive2];
  }
  // Pump.
  const double displacement = Displacement(x);
  rate[kTheta] = x[kOmega];
  rate[kOmega] =
      (Torque(x, torque) - displacement * (pump_2 - pump_1) - PumpLosses(x, viscosity)) / v.rotor_inertia;
  const double cross = CrossLeakage(x, pump_2 - pump_1, viscosity);
  const double outer_1 = v.outer_leakage / viscosity * (pump_1 - supply);
  const double outer_2 = v.outer_leakage / viscosity * (pump_2 - supply);
  double into_1 = -displacement * x[kOmega] + cross - outer_1;  // what the pump sends to each side
  double into_2 = displacement * x[kOmega] - cross - outer_2;
  rate[kReturned] = outer_1 + outer_2;
  // Pipes.
  rate[kPump1] = rate[kPump2] = 0;
  if (line) {
    const double compliance = pump_volume_ / v.bulk_modulus;
    rate[kPump1] = (into_1 - pipe_1_.FlowA(x[kPump1])) / compliance;
    rate[kPump2] = (into_2 - pipe_2_.FlowA(x[kPump2])) / compliance;
    into_1 = -pipe_1_.FlowB(x[kP1]);
    into_2 = -pipe_2_.FlowB(x[kP2]);
  }
  // Valves.
  for (const int lift : {kCheck1, kCheck2, kRelief1, kRelief2}) rate[lift] = 0;
  if (relief_.flow > 0) {
    rate[kRelief1] = (RestingLift(relief_, x[kP1]) - x[kRelief1]) / relief_.time;
    rate[kRelief2] = (RestingLift(relief_, x[kP2]) - x[kRelief2]) / relief_.time;
    const double out_1 = PoppetFlow(relief_, x[kRelief1], x[kP1] - supply);
    const double out_2 = PoppetFlow(relief_, x[kRelief2], x[kP2] - supply);
    into_1 -= out_1;
    into_2 -= out_2;
    rate[kReturned] += out_1 + out_2;
  }
  if (check_.flow > 0) {
    rate[kCheck1] = (RestingLift(check_, supply - x[kP1]) - x[kCheck1]) / check_.time;
    rate[kCheck2] = (RestingLift(check_, supply - x[kP2]) - x[kCheck2]) / check_.time;
    const double in_1 = PoppetFlow(check_, x[kCheck1], supply - x[kP1]);
    const double in_2 = PoppetFlow(check_, x[kCheck2], supply - x[kP2]);
    into_1 += in_1;
    into_2 += in_2;
    rate[kReturned] -= in_1 + in_2;
  }
  // Actuator's sides.
  const Chamber side_1 = ChamberOf(x, 1);
  const Chamber side_2 = ChamberOf(x, 2);
  const double vane_rate = day_.clamped ? 0 : x[kVaneRate];
  into_1 += v.vane_volume * vane_rate;
  into_2 -= v.vane_volume * vane_rate;
  rate[kAir1] = rate[kAir2] = 0;
  if (e.air > 0) {
    AirRates(x, 1, side_1.volume, &rate[kAir1], &into_1);
    AirRates(x, 2, side_2.volume, &rate[kAir2], &into_2);
  }
  const double creep = rig_.outside.hose_creep + rig_.rich.size * rig_.rich.creep;
  rate[kCreep1] = (x[kP1] - x[kCreep1]) / kCreepTime;
  rate[kCreep2] = (x[kP2] - x[kCreep2]) / kCreepTime;
  if (creep > 0) {
    into_1 -= creep * side_1.compliance * rate[kCreep1];
    into_2 -= creep * side_2.compliance * rate[kCreep2];
  }
  if (day_.bypass) {
    rate[kP1] = rate[kP2] = (into_1 + into_2) / (side_1.compliance + side_2.compliance);
  } else {
    rate[kP1] = into_1 / side_1.compliance;
    rate[kP2] = into_2 / side_2.compliance;
  }
  ArmRates(x, rate);
  // Oil temperature goes to an end that it does not reach.
  rate[kCelsius] = 0;
  if (e.warming != 0) {
    const double end = day_.celsius - e.warming * e.warming_time / ViscositySlope(day_.celsius);
    rate[kCelsius] = (end - x[kCelsius]) / e.warming_time;
  }
  // Transducers.
  for (const int stage : {kSense1a, kSense1b, kSense2a, kSense2b}) rate[stage] = 0;
  if (e.pressure_lag > 0) {
    const double first = Stage(e.pressure_lag, 0.7);
    const double second = Stage(e.pressure_lag, 0.3);
    rate[kSense1a] = (x[kP1] - x[kSense1a]) / first;
    rate[kSense1b] = (x[kSense1a] - x[kSense1b]) / second;
    rate[kSense2a] = (x[kP2] - x[kSense2a]) / first;
    rate[kSense2b] = (x[kSense2a] - x[kSense2b]) / second;
  }
}

void Machine::StepBristles(double h) {
  pump_bend_ = Bend(pump_bristles_, pump_bend_, x_[kOmega], DryLimit(x_), h);
  if (rig_.effects.seal_dry > 0 && !day_.clamped)
    seal_bend_ = Bend(seal_bristles_, seal_bend_, x_[kVaneRate], rig_.effects.seal_dry, h);
}

// An ideal valve lets in what is missing at once.
void Machine::FeedFromSupply() {
  if (check_.flow > 0) return;
  const double supply = SupplyPressure(x_);
  for (const int side : {1, 2}) {
    double& p = x_[side == 1 ? kP1 : kP2];
    if (p >= supply) continue;
    x_[kReturned] -= ChamberOf(x_, side).compliance * (supply - p);
    p = supply;
  }
}

void Machine::Step(double volts) {
  volts_ = volts;
  if (!commands_.empty()) {
    volts_ = commands_[command_at_];
    commands_[command_at_] = volts;
    command_at_ = command_at_ + 1 == commands_.size() ? 0 : command_at_ + 1;
  }
  StepBristles(0.5 * kStep);
  const State start = x_;
  State first, second, y;
  Rates(start, first);
  for (int i = 0; i < kStates; ++i) y[i] = start[i] + kStep * first[i];
  Rates(y, second);
  for (int i = 0; i < kStates; ++i) x_[i] = start[i] + 0.5 * kStep * (first[i] + second[i]);
  StepBristles(0.5 * kStep);
  if (pipe_1_.present()) {
    pipe_1_.Step(0.5 * (start[kPump1] + x_[kPump1]), 0.5 * (start[kP1] + x_[kP1]));
    pipe_2_.Step(0.5 * (start[kPump2] + x_[kPump2]), 0.5 * (start[kP2] + x_[kP2]));
  }
  FeedFromSupply();
  ++steps_;
  if (!late_.empty()) {
    late_[late_at_] = SkewedNow();
    late_at_ = late_at_ + 1 == late_.size() ? 0 : late_at_ + 1;
  }
  const double reach = rig_.values.vane_volume * std::abs(x_[kVane]);
  if (!(reach < 0.97 * (rig_.values.mid_volume - pump_volume_ - pipe_volume_)))
    throw std::runtime_error("the actuator reached its end");
  if (!std::isfinite(x_[kOmega] + x_[kP1] + x_[kP2])) throw std::runtime_error("a value is not finite");
}

Reading Machine::Plain() const {
  const Effects& e = rig_.effects;
  const bool lag = e.pressure_lag > 0;
  const double t = std::max(0.0, time() - day_.prelude);
  constexpr double kDriftTime = 20;  // s
  const double drift = kDriftTime * (1 - std::exp(-t / kDriftTime));
  Reading r;
  r.speed = x_[kOmega];
  r.shaft = x_[kTheta];
  r.arm = x_[kArm];
  r.p1 = (lag ? x_[kSense1b] : x_[kP1]) * (1 + e.gain) + e.offset_1 + day_.offset_1 + e.drift_1 * drift;
  r.p2 = (lag ? x_[kSense2b] : x_[kP2]) * (1 + e.gain) + e.offset_2 + day_.offset_2 + e.drift_2 * drift;
  return r;
}

double* Machine::Channel(Reading* reading, Signal signal) {
  switch (signal) {
    case Signal::kMotorSpeed:
      return &reading->speed;
    case Signal::kArmAngle:
      return &reading->arm;
    case Signal::kP1:
      return &reading->p1;
    case Signal::kP2:
      return &reading->p2;
    case Signal::kNone:
      break;
  }
  return nullptr;
}

double Machine::SkewedNow() const {
  Reading now = Plain();
  const double* const channel = Channel(&now, rig_.effects.skewed);
  return channel == nullptr ? 0 : *channel;
}

Reading Machine::Read() const {
  Reading r = Plain();
  if (double* const late = Channel(&r, rig_.effects.skewed); late != nullptr && !late_.empty())
    *late = late_[late_at_];
  return r;
}

void Machine::ContinueFrom(const Machine& other) {
  x_ = other.x_;
  steps_ = other.steps_;
  volts_ = other.volts_;
  pump_bend_ = other.pump_bend_ * other.pump_bristles_.stiffness / pump_bristles_.stiffness;
  if (rig_.effects.seal_dry > 0 && other.rig_.effects.seal_dry > 0)
    seal_bend_ = other.seal_bend_ * other.seal_bristles_.stiffness / seal_bristles_.stiffness;
  if (!joint()) {
    x_[kVane] = x_[kArm];
    x_[kVaneRate] = x_[kArmRate];
  }
  if (pipe_1_.present() && other.pipe_1_.present()) {
    pipe_1_ = other.pipe_1_;
    pipe_2_ = other.pipe_2_;
  } else if (pipe_1_.present()) {
    x_[kPump1] = x_[kP1];
    x_[kPump2] = x_[kP2];
    pipe_1_.Fill(x_[kP1]);
    pipe_2_.Fill(x_[kP2]);
  }
  if (commands_.size() == other.commands_.size()) {
    commands_ = other.commands_;
    command_at_ = other.command_at_;
  }
  if (late_.size() == other.late_.size()) {
    late_ = other.late_;
    late_at_ = other.late_at_;
  }
}

double Machine::Energy() const {
  const Values& v = rig_.values;
  const double volume_1 = ChamberOf(x_, 1).compliance;
  const double volume_2 = ChamberOf(x_, 2).compliance;
  double energy = 0.5 * v.rotor_inertia * x_[kOmega] * x_[kOmega];
  energy += 0.5 * volume_1 * x_[kP1] * x_[kP1] + 0.5 * volume_2 * x_[kP2] * x_[kP2];
  if (!day_.clamped) {
    const double vane = joint() ? vane_inertia_ : v.arm_inertia;
    energy += 0.5 * vane * x_[kVaneRate] * x_[kVaneRate];
    if (joint()) energy += 0.5 * (v.arm_inertia - vane) * x_[kArmRate] * x_[kArmRate];
  }
  return energy;
}

}  // namespace foreign_rig
