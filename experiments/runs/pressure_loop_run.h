// A run of the stack for an experiment on the pressure loop, eq. (16): Table 1, the gains of Figure 8.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/runs/stack_run.h"
#include "model/terms/description.h"
#include "page/plot.h"
#include "pressure_ctrl/law/pressure_law.h"

namespace hydro::experiments {

// Figure 8's pressure loop; the rate approximates the paper's analog circuit.
inline constexpr double kLoopNaturalFrequency = 150;  // rad/s
inline constexpr double kLoopDampingRatio = 0.5;
inline constexpr double kLoopRate = 5000;  // Hz; a command acts at the tick that it is computed from
// psi, for each pressure. An assumption: the paper's plots show noise, but it prints no level.
inline constexpr double kPaperPressureNoise = 15;

struct PressureLoopSetup {
  std::string name;        // the run's name
  std::string reference;   // keys of [reference], one per line
  double duration = 1;     // s
  double feedforward = 0;  // V/psi, of the reference
  bool arm_speed_feedforward = false;
  std::string motion;         // keys of [model.motion] for a driven arm; empty: clamped at mid-stroke
  double pressure_noise = 0;  // psi, standard deviation of each pressure
  int64_t seed = 1;
  double rate = kLoopRate;  // Hz, of plant and loop
};

// The run's signals, one value per tick.
struct PressureLoopRun {
  std::vector<double> time;                  // s
  std::vector<double> reference;             // psi
  std::vector<double> dp;                    // psi, p2 - p1 as measured
  std::vector<double> p1, p2;                // psi
  std::vector<double> motor_speed;           // rad/s
  std::vector<double> arm_angle, arm_speed;  // rad, rad/s
  std::vector<double> torque;                // in-lbf, k_1 v
};

PressureLoopRun RunPressureLoop(const StackRunner& run_stack, const PressureLoopSetup& setup);

// Table 1's parameters, and the gains of these runs.
model::Parameters PressureLoopParameters();
pressure_ctrl::PressureGains PressureLoopGains();

// The value at which dp settles under a constant reference > 0 with the arm held, in closed form: the pump
// creeps forward to compensate the leakage, D theta' = (c_E + c_I) dp with side 1 at p_3, and eq. (4)
// balances eq. (16).
double SettledPressure(double reference, double feedforward);

// The range of dp in which friction keeps a resting pump at rest under that reference: |T_p - D dp| <= T_s.
struct FrictionBand {
  double low = 0;   // psi
  double high = 0;  // psi
};
FrictionBand StickingPressures(double reference, double feedforward);

// Errors over the samples after `from` s.
struct TrackingError {
  double rms = 0;                 // psi
  double saturated_fraction = 0;  // fraction of the time with the motor at its torque limit
  double highest = 0;             // psi, of dp
  double lowest = 0;
};
TrackingError MeasureTracking(const PressureLoopRun& run, double from);

// Mean of reference - dp over the `length` s that end at `until` s.
double MeanError(const PressureLoopRun& run, double until, double length = 0.1);

// A curve of `values` over the run's time, up to `until` s.
page::Curve SignalCurve(const std::string& label, const PressureLoopRun& run,
                        const std::vector<double>& values, int colour, double until,
                        page::Stroke stroke = page::Stroke::kLine);

}  // namespace hydro::experiments
