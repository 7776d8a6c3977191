// A commanded torque at an arm that is driven along a smooth path.
#pragma once

#include <string>
#include <vector>

#include "experiments/runs/pressure_loop_run.h"

namespace hydro::experiments {

// A path from -reach to +reach and back. Each way is a quintic with zero speed and acceleration at both ends,
// and the path rests before, between and after.
class SmoothPath {
 public:
  SmoothPath(double reach, double largest_speed);

  double angle(double time) const;         // rad
  double speed(double time) const;         // rad/s
  double acceleration(double time) const;  // rad/s^2
  double duration() const { return 2 * move_ + 3 * kRest; }
  double middle() const { return kRest + move_ / 2; }  // s, when the path first passes 0, at its peak speed

  static constexpr double kRest = 0.4;  // s

 private:
  struct Phase {
    double share = 0;      // fraction of the move, 0 to 1
    double direction = 0;  // +1, -1, 0 at rest
  };
  Phase At(double time) const;

  double reach_;
  double move_;  // s
};

// The arm of the shipped gravity model under the torque command that carries it along the path: J_a alpha'' +
// m g l cos(alpha), eq. (15).
struct TorqueOnPath {
  double largest_speed = 0;  // rad/s, the arm's
  bool arm_speed_feedforward = false;
  PressureLoopRun run;
  std::vector<double> command;  // in-lbf
  std::vector<double> error;    // in-lbf, command - k_2 dp
  // The error in closed form at each instant: the torque that eq. (4) needs while the arm's motion and the
  // leakage turn the pump, supplied by eq. (16), plus the k_v term.
  std::vector<double> closed_form;
  double largest_error = 0;                 // in-lbf, |command - k_2 dp|
  double rms_error = 0;                     // in-lbf
  double error_at_largest_speed = 0;        // in-lbf, when the arm first passes alpha = 0
  double closed_form_at_largest_speed = 0;  // in-lbf
  double largest_motor_torque = 0;          // in-lbf
  double largest_motor_speed = 0;           // rad/s
};

TorqueOnPath RunTorqueOnPath(const StackRunner& run_stack, double largest_speed, bool arm_speed_feedforward);

}  // namespace hydro::experiments
