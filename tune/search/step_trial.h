// A step of the arm's reference on the full nonlinear model, computed as the stack computes it in lockstep
// but without messages, for searches that need thousands of runs.
#pragma once

#include <cstdint>

#include "model/terms/description.h"
#include "settings/stack_config.h"
#include "tune/design/sampled_position_loop.h"
#include "tune/design/stack_loops.h"

namespace hydro::tune {

struct StepTrial : design::LoopSettings {
  model::ModelDescription model;
  double tick = 0;  // s, of the plant
  settings::NoiseSection noise;
  int64_t seed = 1;
  double start = 0;  // rad, where the arm is before the step
  double rest =
      0;  // s, a whole number of position samples, in which it is held there first; not in the response
  double step = 0;      // rad
  double duration = 0;  // s, after the step
};

// Of a trial: how far the arm still swings there, and which limits still hold it.
inline constexpr double kLastPart = 0.1;

struct StepRun {
  design::Response response;    // the true angle less `start`, one point per tick, from the step on
  double highest_pressure = 0;  // psi, of either side
  double highest_speed = 0;     // rad/s, of the motor
  double saturated = 0;         // s, with the motor at its torque limit or the voltage at the law's limit
  double held_back = 0;         // s, in which limits.arm_torque kept back what the position law asked for
  // The same of the last kLastPart of the trial.
  double saturated_at_end = 0;
  double held_back_at_end = 0;
};

// The arm's response to a reference that steps at a sample of the position loop. Up to rounding, it equals
// the stack's for the same settings. Throws ModelError.
StepRun RunStepTrial(const StepTrial& trial);

// A trial of the stack that `config` describes. The caller adds step and duration.
StepTrial TrialOf(const settings::StackConfig& config);

}  // namespace hydro::tune
