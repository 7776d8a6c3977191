// Where in a measured run the motor turned steadily under a constant voltage.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "runs/measured_run.h"

namespace hydro::experiments {

// What the speed is taken from.
enum class SpeedSource { kSpeed, kAngle };

// A stretch of constant voltage: samples first to last, and how the speed was at its end.
struct Hold {
  size_t first = 0;
  size_t last = 0;
  double voltage = 0;  // V, mean
};

// A window of a run, looked at in ten blocks: the scatter of their speeds about a straight line is the
// measure of errors, whatever the noise's colour.
struct SpeedWindow {
  double from = 0;             // s
  double to = 0;               // s
  double voltage = 0;          // V, mean over the hold
  double speed = 0;            // rad/s, mean
  double speed_error = 0;      // rad/s, standard error of the mean
  double acceleration = 0;     // rad/s^2, of the straight line
  double acceleration_95 = 0;  // rad/s^2, half the width of its 95 % confidence interval
  double hold_from = 0;        // s, since when the voltage is constant
  double first_duration = 0;   // s, the hold's first tenth
  double first_speed = 0;      // rad/s, mean over that
  double duration() const { return to - from; }
  // The most that the speed may be accelerating.
  double LargestAcceleration() const;
};

struct SteadySpeeds {
  std::vector<SpeedWindow> steady;  // in order of time; the pump stands still in none
  // Among holds that are not steady, the longest, if there is one: its later half.
  std::optional<SpeedWindow> longest_unsteady;
};

// Stretches over which the voltage does not change by more than its noise (that of the run, else estimated
// from its differences).
std::vector<Hold> ConstantVoltage(const runs::MeasuredRun& run);

// Looks in each hold for the longest stretch up to its end in which the speed has no significant trend and an
// inertia `inertia` cannot take more than 0.5 % of the torque `torque_per_volt` gives; where noise is too
// small or drift too slow for the first, the second suffices. The later half of the stretch is given: what is
// left of a transient hides in the noise of the whole, but is smaller there. The run must have the source's
// signal.
SteadySpeeds FindSteadySpeeds(const runs::MeasuredRun& run, SpeedSource source, double torque_per_volt,
                              double inertia);

}  // namespace hydro::experiments
