// The rates of change: drive, pump, pipes, valves, sides, arm, transducers.
#include <algorithm>

#include "fluid.h"
#include "machine.h"

namespace foreign_rig {

namespace {

constexpr double kCreepTime = 0.12;  // s
constexpr double kLagFirst = 0.75;   // of a lag, in its first stage

// A stage of a lag is never so short that a step would overshoot.
double Stage(double lag, double part) { return std::max(lag * part, 2 * kStep); }

}  // namespace

// Air goes into solution and comes out of it late; what it gains in volume presses on the oil.
void Machine::AirRates(const State& x, int side, double volume, double* rate, double* flow) const {
  const double p = x[side == 1 ? kP1 : kP2];
  const double absolute = std::max(p, -0.9 * kAtmosphere) + kAtmosphere;
  const double goal = FreeAir(rig_.effects.air, p, kAllDissolved);
  *rate = (goal - x[side == 1 ? kAir1 : kAir2]) / rig_.effects.air_dissolves;
  *flow += volume * kAtmosphere / absolute * *rate;
}

void Machine::ArmRates(const State& x, State& rate) const {
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

Machine::Flows Machine::PumpRates(const State& x, double viscosity, State& rate) const {
  const Values& v = rig_.values;
  const Effects& e = rig_.effects;
  const bool line = pipe_1_.present();
  const double pump_1 = x[line ? kPump1 : kP1];
  const double pump_2 = x[line ? kPump2 : kP2];
  double torque = v.torque_per_volt * volts_;
  if (e.lag > 0) {
    rate[kDrive1] = (torque - x[kDrive1]) / Stage(e.lag, kLagFirst);
    rate[kDrive2] = (x[kDrive1] - x[kDrive2]) / Stage(e.lag, 1 - kLagFirst);
    torque = x[kDrive2];
  }
  const double displacement = Displacement(x);
  const double driven = Torque(x, torque);
  rate[kTheta] = x[kOmega];
  rate[kOmega] = (driven - displacement * (pump_2 - pump_1) - PumpLosses(x, viscosity)) / v.rotor_inertia;
  const double load = driven / v.torque_limit;
  rate[kFade] = rig_.outside.motor_fade * load * load * (1 - x[kFade]);
  const double supply = SupplyPressure(x);
  const double cross = CrossLeakage(x, pump_2 - pump_1, viscosity);
  const double outer_1 = v.outer_leakage / viscosity * (pump_1 - supply);
  const double outer_2 = v.outer_leakage / viscosity * (pump_2 - supply);
  rate[kReturned] = outer_1 + outer_2;
  Flows into = {-displacement * x[kOmega] + cross - outer_1, displacement * x[kOmega] - cross - outer_2};
  if (line) {
    const double compliance = pump_volume_ / v.bulk_modulus;
    rate[kPump1] = (into.side_1 - pipe_1_.FlowA(x[kPump1])) / compliance;
    rate[kPump2] = (into.side_2 - pipe_2_.FlowA(x[kPump2])) / compliance;
    into = {-pipe_1_.FlowB(x[kP1]), -pipe_2_.FlowB(x[kP2])};
  }
  return into;
}

void Machine::ValveRates(const State& x, State& rate, Flows* into) const {
  const double supply = SupplyPressure(x);
  if (relief_.flow > 0) {
    rate[kRelief1] = (RestingLift(relief_, x[kP1]) - x[kRelief1]) / relief_.time;
    rate[kRelief2] = (RestingLift(relief_, x[kP2]) - x[kRelief2]) / relief_.time;
    const double out_1 = PoppetFlow(relief_, x[kRelief1], x[kP1] - supply);
    const double out_2 = PoppetFlow(relief_, x[kRelief2], x[kP2] - supply);
    into->side_1 -= out_1;
    into->side_2 -= out_2;
    rate[kReturned] += out_1 + out_2;
  }
  if (check_.flow > 0) {
    rate[kCheck1] = (RestingLift(check_, supply - x[kP1]) - x[kCheck1]) / check_.time;
    rate[kCheck2] = (RestingLift(check_, supply - x[kP2]) - x[kCheck2]) / check_.time;
    const double in_1 = PoppetFlow(check_, x[kCheck1], supply - x[kP1]);
    const double in_2 = PoppetFlow(check_, x[kCheck2], supply - x[kP2]);
    into->side_1 += in_1;
    into->side_2 += in_2;
    rate[kReturned] -= in_1 + in_2;
  }
}

void Machine::SideRates(const State& x, State& rate, Flows into) const {
  const Chamber side_1 = ChamberOf(x, 1);
  const Chamber side_2 = ChamberOf(x, 2);
  const double vane_rate = day_.clamped ? 0 : x[kVaneRate];
  into.side_1 += rig_.values.vane_volume * vane_rate;
  into.side_2 -= rig_.values.vane_volume * vane_rate;
  if (rig_.effects.air > 0) {
    AirRates(x, 1, side_1.volume, &rate[kAir1], &into.side_1);
    AirRates(x, 2, side_2.volume, &rate[kAir2], &into.side_2);
  }
  const double creep = rig_.outside.hose_creep + rig_.rich.size * rig_.rich.creep;
  if (creep > 0) {
    rate[kCreep1] = (x[kP1] - x[kCreep1]) / kCreepTime;
    rate[kCreep2] = (x[kP2] - x[kCreep2]) / kCreepTime;
    into.side_1 -= creep * side_1.compliance * rate[kCreep1];
    into.side_2 -= creep * side_2.compliance * rate[kCreep2];
  }
  if (day_.bypass) {
    rate[kP1] = rate[kP2] = (into.side_1 + into.side_2) / (side_1.compliance + side_2.compliance);
  } else {
    rate[kP1] = into.side_1 / side_1.compliance;
    rate[kP2] = into.side_2 / side_2.compliance;
  }
}

void Machine::TransducerRates(const State& x, State& rate) const {
  const double lag = rig_.effects.pressure_lag;
  if (lag == 0) return;
  const double first = Stage(lag, 0.7);
  const double second = Stage(lag, 0.3);
  rate[kSense1a] = (x[kP1] - x[kSense1a]) / first;
  rate[kSense1b] = (x[kSense1a] - x[kSense1b]) / second;
  rate[kSense2a] = (x[kP2] - x[kSense2a]) / first;
  rate[kSense2b] = (x[kSense2a] - x[kSense2b]) / second;
}

void Machine::Rates(const State& x, State& rate) const {
  rate.fill(0);
  const double viscosity = x[kCelsius] == 40 ? 1 : RelativeViscosity(x[kCelsius]);
  Flows into = PumpRates(x, viscosity, rate);
  ValveRates(x, rate, &into);
  SideRates(x, rate, into);
  if (!day_.clamped) ArmRates(x, rate);
  TransducerRates(x, rate);
  const Effects& e = rig_.effects;
  if (e.warming == 0) return;
  // The oil goes to an end temperature that it does not reach.
  const double end = day_.celsius - e.warming * e.warming_time / ViscositySlope(day_.celsius);
  rate[kCelsius] = (end - x[kCelsius]) / e.warming_time;
}

}  // namespace foreign_rig
