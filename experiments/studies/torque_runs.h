// Runs that show the arm's torque: with the arm clamped, and with the arm driven.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/runs/pressure_loop_run.h"
#include "experiments/studies/experiment.h"
#include "tune/design/frequency_response.h"

namespace hydro::experiments {

// A commanded torque against a clamped arm: steps and swept sines.
struct TorqueStep {
  double command = 0;                   // in-lbf
  double error = 0;                     // in-lbf, command - torque, settled
  double closed_form_error = 0;         // in-lbf
  double rise_time = 0;                 // s, from 10 to 90 % of the settled value
  double overshoot_percent = 0;         // beyond the command, in percent of it
  std::optional<double> settling_time;  // s, to within 2 % of the settled value
  double saturated_fraction = 0;        // fraction of the time until 0.1 s after the step
  PressureLoopRun run;
};

// Starts from rest, with `feedforward` V/psi on the reference.
TorqueStep RunTorqueStep(const StackRunner& run_stack, double command, double feedforward);

struct TorqueSweep {
  double mean = 0;                            // in-lbf, the commanded torque's
  double amplitude = 0;                       // in-lbf
  std::vector<design::ResponsePoint> points;  // arm torque per commanded torque
  double bandwidth_hz = 0;        // 3 dB below the gain of the lowest points; NaN: beyond the sweep
  double saturated_fraction = 0;  // fraction of the time
  // Fraction of the time with both pressures above p_3, after a valve that opened in an earlier cycle has let
  // fluid in.
  double both_compress_fraction = 0;
};

inline constexpr double kSweepFirst = 0.5;  // Hz
inline constexpr double kSweepLast = 60;    // Hz

TorqueSweep RunTorqueSweep(const StackRunner& run_stack, double mean, double amplitude);

// Half the width of the torque band in which a resting pump stays at rest, whatever is commanded.
double FrictionBandTorque();

// Closed-form bandwidth of the loop without friction, leakage and saturation. compressed_sides: 2, or 1 when
// a valve holds the other side at p_3.
double LinearBandwidthHz(int compressed_sides);

// A commanded torque at an arm that is driven along a smooth path.

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
