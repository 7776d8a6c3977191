// Where the motor turned steadily under a constant voltage in a measured run.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "runs/measured/measured_run.h"

namespace hydro::experiments {

// The signal that gives the speed.
enum class SpeedSource { kSpeed, kAngle };

// A stretch of constant voltage, from sample first to sample last.
struct Hold {
  size_t first = 0;
  size_t last = 0;
  double voltage = 0;  // V, mean
};

// A window of a run, split into ten blocks. The scatter of the block speeds about a straight line measures
// the errors, whatever the noise's colour.
struct SpeedWindow {
  double from = 0;             // s
  double to = 0;               // s
  double voltage = 0;          // V, mean over the hold
  double speed = 0;            // rad/s, mean
  double speed_error = 0;      // rad/s, standard error of the mean
  double acceleration = 0;     // rad/s^2, the straight line's
  double acceleration_95 = 0;  // rad/s^2, half the width of its 95 % confidence interval
  double hold_from = 0;        // s, when the voltage became constant
  double first_duration = 0;   // s, duration of the hold's first tenth
  double first_speed = 0;      // rad/s, mean over that tenth
  double duration() const { return to - from; }
  // The largest acceleration that the errors allow.
  double LargestAcceleration() const;
};

struct SteadySpeeds {
  std::vector<SpeedWindow> steady;  // in order of time; the pump turns in all of them
  // The later half of the longest hold that is not steady, if there is one.
  std::optional<SpeedWindow> longest_unsteady;
};

// Stretches over which the voltage changes by no more than its noise (the run's, or else estimated from its
// differences).
std::vector<Hold> ConstantVoltage(const runs::MeasuredRun& run);

// Finds in each hold the longest stretch up to its end in which the speed has no significant trend and an
// inertia `inertia` can take at most 0.5 % of the torque that `torque_per_volt` gives. Where the noise is too
// small or the drift too slow for the first condition, the second suffices. Returns the later half of the
// stretch, because a remaining transient hides in the noise of the whole stretch but is smaller in the later
// half. The run must have the source's signal.
SteadySpeeds FindSteadySpeeds(const runs::MeasuredRun& run, SpeedSource source, double torque_per_volt,
                              double inertia);

}  // namespace hydro::experiments
