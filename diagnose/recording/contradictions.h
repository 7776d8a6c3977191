// How a recording contradicts itself, whatever the rig: no balance is needed to see it.
#pragma once

#include <string>
#include <vector>

#include "base/maths/spread.h"
#include "model/terms/description.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

// degC: below, no oil of such a machine flows, and above, it burns.
inline constexpr maths::Range kOilTemperatures = {-60, 200};

// One line each with what was found and how to correct it, in this order: equal pressures on both sides, from
// one column used for both or from an open bypass that is not stated; angles that jump by a turn; times
// given for a signal; temperatures that no oil has; a bypass stated to be open while p2 - p1 takes the
// motor's torque, which `model` gives roughly.
std::vector<std::string> Contradictions(const model::ModelDescription& model, const runs::MeasuredRun& run);

}  // namespace hydro::diagnose
