// Offsets of the pressure transducers, from their readings where a one-way valve holds the pressure.
#pragma once

#include <vector>

#include "diagnose/data/run_data.h"
#include "diagnose/locate/disturbance_smoother.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

// Both are 0 if the transducers agree with each other, because then p_3 may be what is wrong, or if a side
// never rests at its lowest pressure.
PressureOffsets RestOffsets(const model::ModelDescription& model, const std::vector<const RunData*>& runs);

}  // namespace hydro::diagnose
