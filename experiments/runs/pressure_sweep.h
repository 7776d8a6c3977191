// Swept sines through the closed pressure loop of the clamped actuator, run on the stack.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "experiments/runs/stack_run.h"
#include "model/terms/description.h"
#include "pressure_ctrl/law/pressure_law.h"
#include "tune/design/frequency_response.h"

namespace hydro::experiments {

// The configuration of a stack that runs the pressure loop with the arm clamped.
struct ClampedLoop {
  double arm_angle = 0;         // rad
  double initial_pressure = 0;  // psi
  double duration = 0;          // s
  double rate_hz = 0;
  int delay_ticks = 0;  // 0: the command of tick k acts from tick k on
  pressure_ctrl::PressureGains gains = {};
  std::string reference;  // the keys of [reference] after its signal
};

// The reference is sampled at every tick; no pressure trips a fault. The model is model.toml.
std::string ClampedLoopConfig(const ClampedLoop& loop);

// One run: a sine whose frequency rises linearly through the band, from a quarter of its lower end to 1.4
// times its upper end.
struct SweptBand {
  double first_hz = 0;
  double last_hz = 0;
  double duration_s = 0;
  double segment_s = 0;  // the estimate's segment length
  int points_per_decade = 16;
};

// Two runs, so that low frequencies get enough cycles.
inline const std::vector<SweptBand> kTwoDecades = {{1, 6, 16, 4}, {6, 100, 16, 2}};

struct PressureSweep {
  std::string name;  // for messages and files
  model::ModelDescription model;
  double arm_angle = 0;                                                // rad, where the arm is clamped
  pressure_ctrl::PressureGains gains;                                  // eq. (16), no feed-forward
  double amplitude = 0;                                                // psi, of dp_ref
  double offset = 0;                                                   // psi, its mean
  double initial_pressure = std::numeric_limits<double>::quiet_NaN();  // psi, both sides; NaN: p_3
  double rest_s = 1;      // s at the offset before the sweep begins
  double rate_hz = 5000;  // of plant and pressure loop, with no delay between them: nearly analog
  std::vector<SweptBand> bands = kTwoDecades;
};

// What the loop did over all runs. Fractions refer to the sweeps' time.
struct SweptPressureLoop {
  std::vector<design::ResponsePoint> points;  // dp per dp_ref, samples per samples
  double saturated_fraction = 0;              // voltage at its limit
  double stuck_fraction = 0;                  // pump at rest
  double both_compress_fraction = 0;          // both valves closed: p1, p2 > p_3
  double largest_torque = 0;                  // in-lbf, |k_1 v|
};

SweptPressureLoop RunPressureSweep(const PressureSweep& sweep, const StackRunner& run_stack);

}  // namespace hydro::experiments
