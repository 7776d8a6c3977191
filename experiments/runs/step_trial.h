// A step of the arm's reference on the full nonlinear model, computed as the stack computes it in lockstep
// but without messages: for searches that need hundreds of runs.
#pragma once

#include "design/sampled_position_loop.h"
#include "model/terms/description.h"
#include "position_ctrl/law/position_law.h"
#include "pressure_ctrl/law/pressure_law.h"

namespace hydro::experiments {

struct StepTrial {
  model::ModelDescription model;
  pressure_ctrl::PressureLawSettings pressure;
  position_ctrl::PositionLawSettings position;
  double tick = 0;        // s, of plant and pressure loop
  int interval = 1;       // ticks between samples of the position loop
  int command_delay = 1;  // ticks, as plant.command_delay_ticks
  double step = 0;        // rad
  double duration = 0;    // s, after the step
};

// The arm's response, one point per tick, to a reference that steps from 0 at the first tick. Up to rounding,
// it equals the stack's for the same settings and a step at a sample of the position loop. Throws ModelError.
design::Response RunStepTrial(const StepTrial& trial);

}  // namespace hydro::experiments
