// A run of the stack for an experiment on the pressure loop, eq. (16): Table 1, the gains of Figure 8.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/runs/stack_run.h"
#include "model/terms/description.h"
#include "page/plot.h"
#include "pressure_ctrl/pressure_law.h"

namespace hydro::experiments {

// Figure 8's pressure loop; the rate stands for the paper's analog circuit.
inline constexpr double kLoopNaturalFrequency = 150;  // rad/s
inline constexpr double kLoopDampingRatio = 0.5;
inline constexpr double kLoopRate = 5000;  // Hz; a command acts at the tick it is computed from
// psi, of each pressure: an assumption, the paper shows noise but prints no level.
inline constexpr double kPaperPressureNoise = 15;

struct PressureLoopSetup {
  std::string name;        // of the run
  std::string reference;   // keys of [reference], one a line
  double duration = 1;     // s
  double feedforward = 0;  // V/psi, of the reference
  bool arm_speed_feedforward = false;
  std::string motion;         // keys of [model.motion]: the arm is driven; empty: clamped at mid-stroke
  double pressure_noise = 0;  // psi, standard deviation of each pressure
  int64_t seed = 1;
  double rate = kLoopRate;  // Hz, of plant and loop
};

// The run's signals, one value a tick.
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

// Table 1's and the gains that those runs have.
model::Parameters PressureLoopParameters();
pressure_ctrl::PressureGains PressureLoopGains();

// What dp settles at under a constant reference > 0 with the arm held, in closed form: the pump creeps
// forward to make up for the leakage, D theta' = (c_E + c_I) dp with side 1 at p_3, and eq. (4) balances
// eq. (16).
double SettledPressure(double reference, double feedforward);

// The dp at which a pump that stands stays so under that reference: friction holds |T_p - D dp| <= T_s.
struct FrictionBand {
  double low = 0;   // psi
  double high = 0;  // psi
};
FrictionBand StickingPressures(double reference, double feedforward);

// Over the samples from `from` s on.
struct TrackingError {
  double rms = 0;                 // psi
  double saturated_fraction = 0;  // of the time, the motor at its torque limit
  double highest = 0;             // psi, of dp
  double lowest = 0;
};
TrackingError MeasureTracking(const PressureLoopRun& run, double from);

// Mean of reference - dp over `length` s up to `until` s.
double MeanError(const PressureLoopRun& run, double until, double length = 0.1);

// Curve of `values` over the run's time, up to `until` s.
page::Curve SignalCurve(const std::string& label, const PressureLoopRun& run,
                        const std::vector<double>& values, int colour, double until,
                        page::Stroke stroke = page::Stroke::kLine);

}  // namespace hydro::experiments
