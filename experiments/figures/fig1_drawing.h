// Figure 1 of the paper as a schematic.
#pragma once

#include <string>

#include "model/terms/description.h"

namespace hydro::experiments {

// An <svg> element: amplifier, motor, pump, the two lines with leakages, one-way valves, accumulator, bypass
// and transducers, the rotary actuator and its arm, in the symbols of eqs. (1) to (15), with the parameters
// (in the paper's units) beside the parts.
std::string ApparatusDrawing(const model::Parameters& parameters);

}  // namespace hydro::experiments
