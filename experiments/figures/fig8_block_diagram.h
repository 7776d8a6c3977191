// The drawing of the paper's Figure 8: the position loop's block diagram with its numbers.
#pragma once

#include <string>

#include "experiments/maths/position_design.h"

namespace hydro::experiments {

// An <svg> element for Figure::drawing.
std::string DrawPositionLoop(const DesignModel& model, double gain);

}  // namespace hydro::experiments
