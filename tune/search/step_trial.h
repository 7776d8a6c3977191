// A step of the arm's reference on the full nonlinear model, computed as the stack computes it in lockstep
// but without messages, for searches that need thousands of runs.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "model/terms/description.h"
#include "position_ctrl/law/position_law.h"
#include "pressure_ctrl/law/pressure_law.h"
#include "settings/stack_config.h"
#include "tune/design/sampled_position_loop.h"

namespace hydro::tune {

struct StepTrial {
  model::ModelDescription model;
  pressure_ctrl::PressureLawSettings pressure;
  position_ctrl::PositionLawSettings position;
  std::optional<position_ctrl::BrakingCurve> curve = {};
  double tick = 0;            // s, of the plant
  int interval = 1;           // ticks between samples of the position loop
  int pressure_interval = 1;  // ticks between samples of the pressure loop
  int command_delay = 1;      // ticks, as plant.command_delay_ticks
  int dac_bits = 0;           // as position.dac_bits
  double dac_range = 0;       // psi
  settings::NoiseSection noise;
  int64_t seed = 1;
  double start = 0;  // rad, where the arm is before the step
  double rest =
      0;  // s, a whole number of position samples, in which it is held there first; not in the response
  double step = 0;      // rad
  double duration = 0;  // s, after the step
};

struct StepRun {
  design::Response response;    // the true angle less `start`, one point per tick, from the step on
  double highest_pressure = 0;  // psi, of either side
  double highest_speed = 0;     // rad/s, of the motor
  double saturated = 0;         // s, with the motor at its torque limit or the voltage at the law's limit
};

// The arm's response to a reference that steps at a sample of the position loop. Up to rounding, it equals
// the stack's for the same settings. Throws ModelError.
StepRun RunStepTrial(const StepTrial& trial);

// A trial of the stack that `config` describes. The caller adds step and duration.
StepTrial TrialOf(const settings::StackConfig& config);

}  // namespace hydro::tune
