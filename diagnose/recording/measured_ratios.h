// What the measured signals say about each other without any model of the oil: sizes that are wrong because
// of a ruler, a data sheet or a unit.
#pragma once

#include <string>
#include <vector>

#include "model/terms/parameter_info.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

// One line for each thing that these runs together show:
// - c/D, from the speeds of motor and arm: it reveals a wrong bore, or a displacement per revolution given as
//   one per radian. Reported where it differs from the model's by more than 4 %, and for each direction where
//   the two directions differ;
// - the ratio of the load cell's force (arm_force) to k_2 (p2 - p1), and the friction between the two;
// - the winding's resistance and k_e, where the command is a current and the voltage was measured too.
std::vector<std::string> RatioRemarks(const model::ModelDescription& model,
                                      const std::vector<runs::MeasuredRun>& runs);

}  // namespace hydro::diagnose
