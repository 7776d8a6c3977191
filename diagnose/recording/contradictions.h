// What a recording says against itself, whatever the rig is: it takes no balance to see.
#pragma once

#include <string>
#include <vector>

#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// One line each, what was found and what mends it. In this order: pressures of both sides that are the same, by one column for both or an
// open bypass that is not stated; angles that jump by a turn; a bypass that is said to be open while p2 - p1 takes the motor's torque,
// which `model` gives roughly.
std::vector<std::string> Contradictions(const model::ModelDescription& model, const runs::MeasuredRun& run);

}  // namespace hydro::diagnose
