// The drawing of the paper's Figure 8: the position loop's block diagram with its numbers.
#pragma once

#include <string>

#include "tune/design/position_design.h"

namespace hydro::experiments {

// An <svg> element for Figure::drawing.
std::string DrawPositionLoop(const design::DesignModel& model, double gain);

}  // namespace hydro::experiments
