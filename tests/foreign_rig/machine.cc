#include "machine.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fluid.h"

namespace foreign_rig {

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

void Machine::Integrate() {
  const State start = x_;
  State first, second, y;
  Rates(start, first);
  for (int i = 0; i < kStates; ++i) y[i] = start[i] + h_ * first[i];
  Rates(y, second);
  for (int i = 0; i < kStates; ++i) x_[i] = start[i] + 0.5 * h_ * (first[i] + second[i]);
  StepBristles(h_);
  if (pipe_1_.present()) {
    pipe_1_.Step(0.5 * (start[kPump1] + x_[kPump1]), 0.5 * (start[kP1] + x_[kP1]));
    pipe_2_.Step(0.5 * (start[kPump2] + x_[kPump2]), 0.5 * (start[kP2] + x_[kP2]));
  }
  FeedFromSupply();
}

void Machine::Step(double volts) {
  volts_ = volts;
  if (!commands_.empty()) {
    volts_ = commands_[command_at_];
    commands_[command_at_] = volts;
    command_at_ = command_at_ + 1 == commands_.size() ? 0 : command_at_ + 1;
  }
  for (int part = 0; part < parts_; ++part) Integrate();
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
  // A temperature handed over would tell this machine how far the other's oil has warmed.
  if (rig_.effects.warming == 0) x_[kCelsius] = day_.celsius;
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
