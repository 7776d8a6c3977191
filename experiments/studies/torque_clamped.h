// A commanded torque against a clamped arm: steps and swept sines.
#pragma once

#include <optional>
#include <vector>

#include "experiments/runs/pressure_loop_run.h"
#include "experiments/studies/experiment.h"
#include "tune/design/frequency_response.h"

namespace hydro::experiments {

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

}  // namespace hydro::experiments
