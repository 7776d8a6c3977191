// Offsets of the pressure transducers, from what they read where a one-way valve holds the pressure.
#pragma once

#include <vector>

#include "diagnose/data/run_data.h"
#include "diagnose/locate/disturbance_smoother.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

// Both 0 where the transducers agree with each other: then it may as well be p_3 that is wrong; and where a
// side never rests at its lowest pressure.
PressureOffsets RestOffsets(const model::ModelDescription& model, const std::vector<const RunData*>& runs);

}  // namespace hydro::diagnose
