#include "physics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hidden_rig {

namespace {

constexpr double kAtmosphere = 14.696;  // psi
constexpr double kPolytropic = 1.4;

// LuGre friction of the pump: its bristles bend by 5 urad. Softer ones would show: a start from rest is free
// of friction while they bend.
constexpr double kPumpBristle = 800000;  // in-lbf/rad
constexpr double kPumpBristleDamping = 217;
constexpr double kPumpBristleSpeed = 0.05;  // rad/s, above which the bristles no longer damp
constexpr double kSealGive = 1e-7;          // rad; the fluid is so stiff that 2e-5 would be 11 psi
constexpr double kSealBristleSpeed = 2e-4;

constexpr double kTransducer = 8e-6;  // s, each of its two poles

constexpr double kVaneInertia = 0.1;  // lbf in s^2, what of J_a is on the vane's side of a flexible coupling

double Softplus(double x, double width) {
  const double u = x / width;
  return u > 30 ? x : u < -30 ? 0 : width * std::log1p(std::exp(u));
}

double SoftClamp(double x, double limit, double rounding) {
  return x - Softplus(x - limit, rounding) + Softplus(-x - limit, rounding);
}

}  // namespace

Physics::Physics(const RigSetup& setup, const Plan& plan, const Conditions& conditions)
    : base_(setup.base),
      fx_(setup.effects),
      out_(setup.outside),
      plan_(plan),
      trivia_(conditions.trivia),
      wave_(fx_.wave_hz > 0),
      joint_(fx_.flexure_stiffness > 0 || out_.backlash > 0),
      active_(wave_ ? kStates : kLine1),
      day_(conditions.time_of_day),
      horizon_(60) {
  if (wave_) line_ = TuneLine(fx_.wave_hz, fx_.wave_fraction, fx_.wave_damping, base_.V_ms, base_.beta);
  if (out_.backlash > 0 && fx_.flexure_stiffness == 0) {
    fx_.flexure_stiffness = 3e6;
    fx_.flexure_damping = 2000;
  }
  if (fx_.seal_coulomb > 0) {
    seal_stiffness_ = fx_.seal_coulomb / kSealGive;
    seal_damping_ = 2 * std::sqrt(seal_stiffness_ * base_.J_a);
  }
  double angle = plan_.arm_angle;
  x_[kSide1] = x_[kSide2] = base_.p_3;
  if (plan_.shaft == Shaft::kDriven) angle = Motion(0);
  x_[kActuator] = x_[kArm] = angle;
  if (plan_.shaft == Shaft::kFree && !plan_.bypass) {
    // At rest: the pressures carry the arm, the pump's friction holds the pressures.
    const double load =
        base_.mgl * std::cos(angle) + out_.gravity_sine * std::sin(angle) + out_.arm_spring * angle;
    x_[load > 0 ? kSide2 : kSide1] += std::abs(load) / base_.k_2;
    if (joint_)
      x_[kActuator] = angle + load / fx_.flexure_stiffness + (load > 0 ? 0.5 : -0.5) * out_.backlash;
    pump_bristle_ = -base_.D * (x_[kSide2] - x_[kSide1]) / kPumpBristle;
  }
  x_[kHose1] = x_[kSide1];
  x_[kHose2] = x_[kSide2];
  x_[kSensor1] = x_[kSensor1b] = x_[kSide1];
  x_[kSensor2] = x_[kSensor2b] = x_[kSide2];
  for (int i = 0; i < kLineNodes; ++i) {
    x_[kLine1 + i] = x_[kSide1];
    x_[kLine2 + i] = x_[kSide2];
  }
}

double Physics::Motion(double t) const {
  return plan_.arm_angle +
         plan_.motion_amplitude * 0.5 * (1 - std::cos(2 * std::numbers::pi * plan_.motion_hz * t));
}
double Physics::MotionRate(double t) const {
  return plan_.motion_amplitude * std::numbers::pi * plan_.motion_hz *
         std::sin(2 * std::numbers::pi * plan_.motion_hz * t);
}

double Physics::Volume(const State& x, int side) const {
  const double v =
      base_.V_ms + (side == 1 ? -1 : 1) * base_.c * x[kActuator] - (wave_ ? line_.fixed_volume : 0);
  if (!(v > 0.02)) throw std::runtime_error("the actuator reached its end");
  return v;
}

double Physics::BulkModulus(double t, double p) const {
  double beta = base_.beta + fx_.stiffening * p;
  if (trivia_) beta *= 1 + 0.0002 * std::sin(2.1 * t + 0.4);
  if (fx_.air_fraction > 0) {
    const double absolute = std::max(p, 0.0) + kAtmosphere;
    const double air =
        fx_.air_fraction * std::pow(kAtmosphere / absolute, 1 / kPolytropic) / (kPolytropic * absolute);
    beta = 1 / (1 / beta + air);
  }
  return beta;
}

double Physics::AccumulatorPressure(const State& x) const {
  return base_.p_3 + fx_.accumulator * x[kReturned];
}

double Physics::Coulomb(double speed, double p1, double p2) const {
  double g = base_.T_s;
  if (fx_.stribeck_excess != 0) {
    const double s = speed / fx_.stribeck_speed;
    g *= 1 + fx_.stribeck_excess * std::exp(-s * s);
  }
  g += (base_.f + fx_.pressure_friction) * (p1 + p2) + (speed > 0 ? 1 : -1) * fx_.asymmetry_coulomb;
  return std::max(g, 1e-3);
}

// Bristles follow exactly for a constant speed: they are far too stiff for an explicit step.
void Physics::StepBristles(double h) {
  const double w = x_[kOmega];
  const double p1 = wave_ ? x_[kLine1] : x_[kSide1];
  const double p2 = wave_ ? x_[kLine2] : x_[kSide2];
  const double rest = Coulomb(w, p1, p2) / kPumpBristle * (w > 0 ? 1 : -1);
  pump_bristle_ = rest + (pump_bristle_ - rest) * std::exp(-std::abs(w) * h / std::abs(rest));
  if (seal_stiffness_ > 0) {
    const double a = x_[kActuatorRate];
    const double end = kSealGive * (a > 0 ? 1 : -1);
    seal_bristle_ = end + (seal_bristle_ - end) * std::exp(-std::abs(a) * h / kSealGive);
  }
}

// Without valve.check the one-way valves are as good as ideal: after each step they have let in what was
// missing.
void Physics::CloseValves() {
  if (fx_.check_conductance > 0) return;
  const double p3 = AccumulatorPressure(x_);
  if (plan_.bypass) {
    if (x_[kSide1] < p3) {
      x_[kReturned] -= (p3 - x_[kSide1]) * (Volume(x_, 1) + Volume(x_, 2)) / base_.beta;
      x_[kSide1] = x_[kSide2] = p3;
    }
    return;
  }
  for (int side = 1; side <= 2; ++side) {
    double& p = x_[side == 1 ? kSide1 : kSide2];
    if (p >= p3) continue;
    x_[kReturned] -= (p3 - p) * Volume(x_, side) / base_.beta;
    p = p3;
  }
}

// A side's line: `q` leaves its pump's end (eq. (11) or (12) there), `fed` arrives at the actuator.
void Physics::AddLine(const State& x, int at, double q, double* rate, double* fed) const {
  const double* pressure = &x[at];
  const double* flow = &x[at + kLineNodes];
  const double end = at == kLine1 ? x[kSide1] : x[kSide2];
  for (int i = 0; i < kLineNodes; ++i) {
    const double in = i == 0 ? -q : flow[i - 1];
    rate[at + i] = BulkModulus(0, pressure[i]) / line_.volume[i] * (in - flow[i]);
    const double next = i + 1 < kLineNodes ? pressure[i + 1] : end;
    rate[at + kLineNodes + i] = (pressure[i] - next - line_.resistance * flow[i]) / line_.inertance;
  }
  *fed = flow[kPieces - 1];
}

// What the motor gives to the pump's shaft.
double Physics::MotorTorque(double t, const State& x, State& rate) const {
  const double w = x[kOmega];
  double asked = base_.k_1 * applied_;
  if (out_.torque_fade > 0) asked *= 1 - x[kFade];
  rate[kCurrent] = fx_.lag_tau > 0 ? (asked - x[kCurrent]) / fx_.lag_tau : 0;
  double torque = fx_.lag_tau > 0 ? x[kCurrent] : asked;
  if (fx_.no_load_speed > 0) {
    torque = std::clamp(torque, -base_.T_pmax, base_.T_pmax);
    if (torque * w > 0) {
      const double limit = base_.T_pmax * Softplus(1 - std::abs(w) / fx_.no_load_speed, 0.002);
      torque = std::copysign(std::min(std::abs(torque), limit), torque);
    }
  } else {
    torque = SoftClamp(torque, base_.T_pmax, 0.02);
  }
  if (out_.torque_saturation > 0)
    torque *= 1 - out_.torque_saturation * torque * torque / (base_.T_pmax * base_.T_pmax);
  rate[kFade] = out_.torque_fade * std::abs(torque) / base_.T_pmax;
  if (trivia_) torque *= 1 + 0.001 * std::sin(12 * x[kTheta] + 1);
  if (fx_.cogging > 0) {
    const double turn = fx_.cogging_periods * x[kTheta] + fx_.cogging_phase;
    torque -= fx_.cogging * (std::sin(turn) + 0.01 * std::sin(2 * turn));
  }
  if (out_.daily_torque > 0) torque -= out_.daily_torque * std::sin(2 * std::numbers::pi * (t + day_) / 7.3);
  return torque;
}

// `warm`: by what the oil's warming divides its viscosity.
double Physics::PumpFriction(const State& x, double pump1, double pump2, double warm) const {
  const double w = x[kOmega];
  const double g = Coulomb(w, pump1, pump2);
  const double fast = w / kPumpBristleSpeed;
  double friction = kPumpBristle * pump_bristle_ + base_.b / warm * w;
  if (std::abs(fast) < 6) {
    friction +=
        kPumpBristleDamping * std::exp(-fast * fast) * (w - std::abs(w) * kPumpBristle * pump_bristle_ / g);
  }
  friction += fx_.asymmetry_viscous * std::abs(w) + fx_.quadratic_drag * w * std::abs(w);
  return friction;
}

// Flow through relief and check valves: changes what leaves the sides.
void Physics::AddValves(const State& x, double p3, State& rate, double* q1, double* q2) const {
  if (fx_.relief_conductance > 0) {
    const double out1 = fx_.relief_conductance * Softplus(x[kSide1] - fx_.relief_set, 2);
    const double out2 = fx_.relief_conductance * Softplus(x[kSide2] - fx_.relief_set, 2);
    *q1 += out1;
    *q2 += out2;
    rate[kReturned] += out1 + out2;
  }
  if (fx_.check_conductance > 0) {
    const double opens = p3 - fx_.check_cracking;
    const double in1 = fx_.check_conductance * Softplus(opens - x[kSide1], 0.1);
    const double in2 = fx_.check_conductance * Softplus(opens - x[kSide2], 0.1);
    *q1 -= in1;
    *q2 -= in2;
    rate[kReturned] -= in1 + in2;
  }
}

// The pressures at the actuator, whose vane moves with `vane_rate`.
void Physics::AddPressures(double t, const State& x, double q1, double q2, double vane_rate,
                           State& rate) const {
  double softness1 = Volume(x, 1) / BulkModulus(t, x[kSide1]);
  double softness2 = Volume(x, 2) / BulkModulus(t, x[kSide2]);
  double flow1 = -(q1 - base_.c * vane_rate);
  double flow2 = -(q2 + base_.c * vane_rate);
  rate[kHose1] = rate[kHose2] = 0;
  if (out_.hose_creep > 0) {
    rate[kHose1] = (x[kSide1] - x[kHose1]) / 0.15;
    rate[kHose2] = (x[kSide2] - x[kHose2]) / 0.15;
    flow1 -= out_.hose_creep * softness1 * rate[kHose1];
    flow2 -= out_.hose_creep * softness2 * rate[kHose2];
  }
  if (plan_.bypass) {
    rate[kSide1] = rate[kSide2] = (flow1 + flow2) / (softness1 + softness2);
  } else {
    rate[kSide1] = flow1 / softness1;
    rate[kSide2] = flow2 / softness2;
  }
}

double Physics::VaneTorque(const State& x) const {
  double vane = base_.k_2 * (x[kSide2] - x[kSide1]) - fx_.seal_viscous * x[kActuatorRate];
  if (seal_stiffness_ > 0) {
    const double quick = x[kActuatorRate] / kSealBristleSpeed;
    vane -= seal_stiffness_ * seal_bristle_;
    if (std::abs(quick) < 6) {
      vane -= seal_damping_ * std::exp(-quick * quick) *
              (x[kActuatorRate] - std::abs(x[kActuatorRate]) * seal_bristle_ / kSealGive);
    }
  }
  return vane;
}

double Physics::LinkTorque(double t, const State& x) const {
  const double angle = x[kArm];
  double link = -base_.mgl * std::cos(angle) - out_.gravity_sine * std::sin(angle) - out_.arm_spring * angle;
  if (out_.end_cushion > 0)
    link -= out_.end_cushion * (Softplus(angle - 0.12, 0.002) - Softplus(-angle - 0.12, 0.002));
  if (out_.floor_vibration > 0)
    link += out_.floor_vibration * std::sin(2 * std::numbers::pi * 9.0 * (t + day_));
  return link;
}

// The arm where nothing outside moves it.
void Physics::AddArm(double t, const State& x, State& rate) const {
  const double vane = VaneTorque(x);
  const double link = LinkTorque(t, x);
  if (joint_) {
    const double twist = x[kActuator] - x[kArm];
    const double play = 0.5 * out_.backlash;
    const double stretch = twist > play ? twist - play : twist < -play ? twist + play : 0;
    const double touching = play > 0 ? std::min(1.0, std::abs(stretch) / 2e-6) : 1;
    const double through =
        fx_.flexure_stiffness * stretch + touching * fx_.flexure_damping * (x[kActuatorRate] - x[kArmRate]);
    rate[kActuator] = x[kActuatorRate];
    rate[kActuatorRate] = (vane - through) / kVaneInertia;
    rate[kArm] = x[kArmRate];
    rate[kArmRate] = (through + link) / (base_.J_a - kVaneInertia);
  } else {
    rate[kActuator] = rate[kArm] = x[kActuatorRate];
    rate[kActuatorRate] = rate[kArmRate] = (vane + link) / base_.J_a;
  }
}

// Transducers: two poles, the first of which is sensor.pressure_lag's if there is one. Tachometer: one.
void Physics::AddSensors(const State& x, State& rate) const {
  const double slow = fx_.sensor_tau > 0 ? 0.98 * fx_.sensor_tau : kTransducer;
  const double quick = fx_.sensor_tau > 0 ? std::max(0.02 * fx_.sensor_tau, kTransducer) : kTransducer;
  if (fx_.sensor_tau > 0 || trivia_) {
    rate[kSensor1] = (x[kSide1] - x[kSensor1]) / slow;
    rate[kSensor2] = (x[kSide2] - x[kSensor2]) / slow;
    rate[kSensor1b] = (x[kSensor1] - x[kSensor1b]) / quick;
    rate[kSensor2b] = (x[kSensor2] - x[kSensor2b]) / quick;
  } else {
    rate[kSensor1] = rate[kSensor1b] = rate[kSensor2] = rate[kSensor2b] = 0;  // Step() copies
  }
  rate[kTachometer] = trivia_ ? (x[kOmega] - x[kTachometer]) / 8e-5 : 0;
}

void Physics::Rates(double t, const State& x, State& rate) const {
  const double w = x[kOmega];
  const double pump1 = wave_ ? x[kLine1] : x[kSide1];
  const double pump2 = wave_ ? x[kLine2] : x[kSide2];
  const double dp = pump2 - pump1;
  const double torque = MotorTorque(t, x, rate);

  double D = base_.D;
  if (fx_.flow_ripple > 0) D *= 1 + fx_.flow_ripple * std::cos(fx_.flow_ripple_periods * x[kTheta]);
  double warm = 1;
  if (fx_.warming != 0) warm = std::exp(x[kHeat]);
  rate[kTheta] = w;
  rate[kOmega] = (torque - D * dp - PumpFriction(x, pump1, pump2, warm)) / base_.J;
  // The oil warms towards an end temperature that it does not reach during a run.
  constexpr double kThermal = 60;  // s
  rate[kHeat] = fx_.warming == 0 ? 0 : 1.014 * fx_.warming - x[kHeat] / kThermal;

  // Leakage at the pump.
  const double p3 = AccumulatorPressure(x);
  double cross = (base_.c_I * warm + out_.leakage_position * std::abs(x[kActuator])) * dp;
  if (fx_.turbulent_leakage > 0) cross += fx_.turbulent_leakage * dp / std::sqrt(std::sqrt(dp * dp + 9));
  const double outer1 = base_.c_E * warm * (pump1 - p3);
  const double outer2 = base_.c_E * warm * (pump2 - p3);
  double q1 = D * w - cross + outer1;
  double q2 = -D * w + cross + outer2;
  rate[kReturned] = outer1 + outer2;

  if (wave_) {
    double fed1 = 0;
    double fed2 = 0;
    AddLine(x, kLine1, q1, rate.data(), &fed1);
    AddLine(x, kLine2, q2, rate.data(), &fed2);
    q1 = -fed1;
    q2 = -fed2;
  }
  AddValves(x, p3, rate, &q1, &q2);
  const bool driven = plan_.shaft == Shaft::kDriven;
  const double vane_rate = driven ? MotionRate(t) : x[kActuatorRate];
  AddPressures(t, x, q1, q2, vane_rate, rate);

  rate[kActuator] = rate[kActuatorRate] = rate[kArm] = rate[kArmRate] = 0;
  if (driven) {
    rate[kActuator] = rate[kArm] = vane_rate;
  } else if (plan_.shaft == Shaft::kFree) {
    AddArm(t, x, rate);
  }
  AddSensors(x, rate);
}

void Physics::Step(double voltage) {
  const double now = time();
  if (fx_.delay > 0) {
    if (voltage != last_command_) commands_.emplace_back(now + fx_.delay, voltage);
    last_command_ = voltage;
    while (!commands_.empty() && commands_.front().first <= now + 0.5 * kStep) {
      applied_ = commands_.front().second;
      commands_.pop_front();
    }
  } else {
    applied_ = voltage;
  }
  StepBristles(0.5 * kStep);
  State k1, k2, k3, k4, y = x_;
  Rates(now, x_, k1);
  for (int i = 0; i < active_; ++i) y[i] = x_[i] + 0.5 * kStep * k1[i];
  Rates(now + 0.5 * kStep, y, k2);
  for (int i = 0; i < active_; ++i) y[i] = x_[i] + 0.5 * kStep * k2[i];
  Rates(now + 0.5 * kStep, y, k3);
  for (int i = 0; i < active_; ++i) y[i] = x_[i] + kStep * k3[i];
  Rates(now + kStep, y, k4);
  for (int i = 0; i < active_; ++i) x_[i] += kStep / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  StepBristles(0.5 * kStep);
  CloseValves();
  if (!trivia_) x_[kTachometer] = x_[kOmega];
  if (!trivia_ && fx_.sensor_tau <= 0) {
    x_[kSensor1] = x_[kSensor1b] = x_[kSide1];
    x_[kSensor2] = x_[kSensor2b] = x_[kSide2];
  }
  ++steps_;
  if (!std::isfinite(x_[kOmega] + x_[kSide1] + x_[kSide2] + x_[kArm])) throw std::runtime_error("not finite");
}

}  // namespace hidden_rig
