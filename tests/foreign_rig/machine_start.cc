// How a run begins: the day's values, bristles, pipes, and a state in which nothing moves; and what of a
// start is free.
#include <algorithm>
#include <cmath>

#include "fluid.h"
#include "machine.h"

namespace foreign_rig {

namespace {

constexpr double kPumpGive = 1e-5;      // rad that bristles bend where no richer form is asked for
constexpr double kSealGive = 5e-6;      // rad
constexpr double kVaneShare = 0.02;     // of the arm's inertia that is on the vane's side of a soft shaft
constexpr double kPlayStiffness = 3e6;  // in-lbf/rad where nothing else is said
constexpr double kPipeShare = 0.2;      // of what is not at the actuator, in the pipe itself

}  // namespace

Machine::Machine(const Rig& rig, const Day& day) : rig_(rig), day_(day) {
  Values& v = rig_.values;
  v.dry_torque *= day.friction * (1 + rig_.rich.size * rig_.rich.daily_friction * day.friction_draw);
  v.arm_weight *= 1 + day.payload;
  v.arm_inertia *= 1 + day.payload;
  v.supply_pressure += day.supply;
  BuildParts();
  Place();
}

void Machine::BuildParts() {
  const Values& v = rig_.values;
  Effects& e = rig_.effects;
  vane_inertia_ = kVaneShare * v.arm_inertia;
  if (rig_.outside.backlash > 0 && e.shaft_stiffness == 0) e.shaft_stiffness = kPlayStiffness;
  const bool stiff =
      e.check_flow > 0 || rig_.outside.backlash > 0 || e.line_delay > 0 || (e.seal_dry > 0 && joint());
  parts_ = stiff ? 4 : 1;
  h_ = kStep / parts_;
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
    pipe_volume_ = kPipeShare * e.line_part * v.mid_volume;
    pump_volume_ = (1 - kPipeShare) * e.line_part * v.mid_volume;
    const double impedance = e.line_delay * v.bulk_modulus / pipe_volume_;
    pipe_1_ = pipe_2_ = Pipe(e.line_delay, impedance, e.line_loss, h_);
  }
  commands_.assign(static_cast<size_t>(std::lround(e.delay / kStep)), 0.0);
  late_.assign(static_cast<size_t>(std::lround(e.skew / kStep)), 0.0);
}

void Machine::Place() {
  const Values& v = rig_.values;
  const Effects& e = rig_.effects;
  x_[kTheta] = day_.shaft_angle;
  x_[kVane] = x_[kArm] = day_.arm_angle;
  x_[kP1] = v.supply_pressure + std::max(0.0, day_.pressure_1);
  x_[kP2] = v.supply_pressure + std::max(0.0, day_.pressure_2);
  if (!day_.clamped) {
    // The pressures carry the arm.
    const double load = Load(x_);
    const double across = std::abs(load) / v.arm_torque;
    x_[load > 0 ? kP2 : kP1] = x_[load > 0 ? kP1 : kP2] + across;
    if (joint()) x_[kVane] += load / e.shaft_stiffness + std::copysign(0.5 * rig_.outside.backlash, load);
  }
  if (day_.bypass) x_[kP1] = x_[kP2] = 0.5 * (x_[kP1] + x_[kP2]);
  x_[kPump1] = x_[kCreep1] = x_[kSense1a] = x_[kSense1b] = x_[kP1];
  x_[kPump2] = x_[kCreep2] = x_[kSense2a] = x_[kSense2b] = x_[kP2];
  if (pipe_1_.present()) {
    pipe_1_.Fill(x_[kP1]);
    pipe_2_.Fill(x_[kP2]);
  }
  x_[kCelsius] = day_.celsius;
  x_[kAir1] = FreeAir(e.air, x_[kP1], kAllDissolved);
  x_[kAir2] = FreeAir(e.air, x_[kP2], kAllDissolved);
  // The pump's bristles hold what the pressures push.
  const double full = v.dry_torque / pump_bristles_.stiffness;
  pump_bend_ = std::clamp(-v.displacement * (x_[kP2] - x_[kP1]) / pump_bristles_.stiffness, -full, full);
  if (!late_.empty()) std::fill(late_.begin(), late_.end(), SkewedNow());
}

std::vector<Machine::Start> Machine::FreeStarts() const {
  std::vector<Start> free = {Start::kSpeed, Start::kPressure1};
  if (!day_.bypass) free.push_back(Start::kPressure2);
  if (!day_.clamped) free.insert(free.end(), {Start::kArm, Start::kArmRate});
  const Effects& e = rig_.effects;
  if (e.cogging != 0 || e.piston_ripple != 0 || rig_.rich.size * rig_.rich.once_a_turn != 0)
    free.push_back(Start::kShaft);
  return free;
}

void Machine::Shift(Start start, double by) {
  switch (start) {
    case Start::kSpeed:
      x_[kOmega] += by;
      break;
    case Start::kPressure1:
      x_[kP1] += by;
      if (day_.bypass) x_[kP2] += by;
      break;
    case Start::kPressure2:
      x_[kP2] += by;
      break;
    case Start::kArm:
      x_[kVane] += by;
      x_[kArm] += by;
      break;
    case Start::kArmRate:
      x_[kVaneRate] += by;
      x_[kArmRate] += by;
      break;
    case Start::kShaft:
      x_[kTheta] += by;
      break;
  }
}

}  // namespace foreign_rig
