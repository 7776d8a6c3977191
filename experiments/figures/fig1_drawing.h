// Figure 1 of the paper as a schematic.
#pragma once

#include <string>

#include "model/terms/description.h"

namespace hydro::experiments {

// An <svg> element: amplifier, motor, pump, the two lines with their leakages, one-way valves, accumulator,
// bypass and transducers, the rotary actuator and its arm. Symbols are those of eqs. (1) to (15); the
// parameters stand beside the parts, in the paper's units.
std::string ApparatusDrawing(const model::Parameters& parameters);

}  // namespace hydro::experiments
