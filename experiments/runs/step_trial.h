// A step of the arm's reference on the full nonlinear model, as the stack runs it in lockstep but without its
// messages: for searches that need hundreds of runs.
#pragma once

#include "experiments/maths/sampled_position_loop.h"
#include "model/terms/description.h"
#include "position_ctrl/position_law.h"
#include "pressure_ctrl/pressure_law.h"

namespace hydro::experiments {

struct StepTrial {
  model::ModelDescription model;
  pressure_ctrl::PressureLawSettings pressure;
  position_ctrl::PositionLawSettings position;
  double tick = 0;        // s, of plant and pressure loop
  int interval = 1;       // ticks from one sample of the position loop to the next
  int command_delay = 1;  // ticks, as plant.command_delay_ticks
  double step = 0;        // rad
  double duration = 0;    // s, from the step on
};

// The arm's answer, one point a tick, to a reference that steps from 0 at the first tick. Equals, up to
// rounding, what the stack gives for the same settings and a step at a sample of the position loop. Throws
// ModelError.
Response RunStepTrial(const StepTrial& trial);

}  // namespace hydro::experiments
