// A step of a whole stack in simulation: plant, pressure loop and position loop as the programs run them.
#pragma once

#include "settings/stack_config.h"
#include "tune/search/step_judge.h"

namespace hydro::tune {

// Runs `config`, including its noise, with a step of its reference from mid-stroke, and measures it against
// `step.shortest`. Throws std::runtime_error, naming the step, when a fault ends the run.
StepResult SimulateStep(settings::StackConfig config, const StepCase& step);

}  // namespace hydro::tune
