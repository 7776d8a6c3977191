// What the measured signals say of each other without any model of the oil: sizes that a ruler, a data sheet or a unit has wrong.
#pragma once

#include <string>
#include <vector>

#include "model/terms/parameter_info.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// One line for each thing that these runs together say:
// - c/D, from the speeds of motor and arm: a bore, or a displacement per revolution where one per radian is meant. Said where it is not the
//   model's within 4 %, and by direction where the two directions differ;
// - how much of the load cell's force (arm_force) k_2 (p2 - p1) is, and the friction between the two;
// - the winding's resistance and k_e, where a current commands and the voltage was measured beside it.
std::vector<std::string> RatioRemarks(const model::ModelDescription& model,
                                      const std::vector<runs::MeasuredRun>& runs);

}  // namespace hydro::diagnose
