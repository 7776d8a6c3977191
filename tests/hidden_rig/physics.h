// The rig's differential equations and how they are stepped.
#pragma once

#include <array>
#include <deque>

#include "line.h"
#include "rig.h"

namespace hidden_rig {

inline constexpr double kStep = 1e-5;  // s

// Where the states lie.
enum {
  kTheta,
  kOmega,  // motor
  kActuator,
  kActuatorRate,  // the vane
  kArm,
  kArmRate,   // the link; follows the vane rigidly without flexure and play
  kCurrent,   // in-lbf, torque of the current loop
  kReturned,  // in^3 returned to the accumulator
  kHeat,      // what the oil has warmed, as an exponent
  kFade,      // part of k_1 lost
  kSide1,
  kSide2,  // psi, at the actuator
  kHose1,
  kHose2,  // psi, that the slow part of the hoses has followed
  kSensor1,
  kSensor1b,
  kSensor2,
  kSensor2b,
  kTachometer,
  kLine1,  // pressures, then flows
  kLine2 = kLine1 + kLineNodes + kPieces,
  kStates = kLine2 + kLineNodes + kPieces
};

class Physics {
 public:
  Physics(const RigSetup& setup, const Plan& plan, const Conditions& conditions);

  // One kStep under the voltage commanded now.
  void Step(double voltage);
  const std::array<double, kStates>& state() const { return x_; }
  double time() const { return steps_ * kStep; }

 private:
  using State = std::array<double, kStates>;
  void Rates(double t, const State& x, State& rate) const;
  double MotorTorque(double t, const State& x, State& rate) const;
  double PumpFriction(const State& x, double pump1, double pump2, double warm) const;
  void AddValves(const State& x, double p3, State& rate, double* q1, double* q2) const;
  void AddPressures(double t, const State& x, double q1, double q2, double vane_rate, State& rate) const;
  double VaneTorque(const State& x) const;
  double LinkTorque(double t, const State& x) const;
  void AddArm(double t, const State& x, State& rate) const;
  void AddSensors(const State& x, State& rate) const;
  void AddLine(const State& x, int at, double q, double* rate, double* fed) const;
  double Coulomb(double speed, double p1, double p2) const;
  double Motion(double t) const;
  double MotionRate(double t) const;
  double BulkModulus(double t, double p) const;
  double AccumulatorPressure(const State& x) const;
  void StepBristles(double h);
  void CloseValves();
  double Volume(const State& x, int side) const;

  Base base_;
  Effects fx_;
  Outside out_;
  Plan plan_;
  bool trivia_, wave_, joint_;
  int active_;  // states in use
  double day_;
  double horizon_;
  Line line_;
  State x_{};
  double pump_bristle_ = 0, seal_bristle_ = 0;
  double seal_stiffness_ = 0, seal_damping_ = 0;
  double applied_ = 0;                              // V, after the delay
  std::deque<std::pair<double, double>> commands_;  // when it acts, V
  double last_command_ = 0;
  int64_t steps_ = 0;
};

}  // namespace hidden_rig
