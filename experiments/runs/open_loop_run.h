// The clamped actuator under a constant motor torque. Its sticks, slips and extremes are located in time.
#pragma once

#include <cstddef>
#include <vector>

#include "base/tables/table.h"
#include "model/terms/description.h"

namespace hydro::experiments {

// Changes and extremes are located to within this much before the time given.
inline constexpr double kLocatedWithin = 1e-6;  // s

struct PumpChange {
  double time = 0;      // s
  bool sticks = false;  // else it slips
  double dp = 0;        // psi, p_2 - p_1
};

struct PressureExtreme {
  double time = 0;    // s
  bool high = false;  // a peak of dp, else a trough
  double dp = 0;      // psi
  double p2 = 0;      // psi
};

struct OpenLoopRun {
  // Samples, the first at 0 s.
  std::vector<double> time;         // s
  std::vector<double> dp;           // psi
  std::vector<double> p1;           // psi
  std::vector<double> p2;           // psi
  std::vector<double> motor_speed;  // rad/s

  std::vector<PumpChange> changes;  // except the break-away at 0 s
  std::vector<PressureExtreme> extremes;

  // The number of changes to sticking after `from` s.
  size_t sticks(double from = 0) const;
};

// Starts at rest at mid-stroke with both pressures at p_3. Throws ModelError.
OpenLoopRun RunOpenLoop(const model::ModelDescription& model, double torque, double duration,
                        double sample_interval = 1e-3);

// Sustained stick-slip cycles, judged in the second half of a run.
struct StickSlipCycles {
  bool sustained = false;  // the pump sticks at least three times; otherwise the rest is 0
  double period = 0;       // s, mean
  double high = 0;         // psi, largest and smallest dp
  double low = 0;
  double stick_dp = 0;  // psi, dp at the last stick, and at the slip that ends a stick
  double slip_dp = 0;
  double stick_time = 0;  // s, duration of the last stick that ends within the run
};
StickSlipCycles FindCycles(const OpenLoopRun& run);

}  // namespace hydro::experiments
