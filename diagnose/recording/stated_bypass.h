// What a recording shows of the bypass, held against what its sidecar says of it.
#pragma once

#include <string>

#include "model/terms/terms.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// The contradiction, with the line that mends it; empty where there is none, or nothing shows. Closed oil is a spring between motor and arm:
// the motor's torque meets it or does not, with pressures recorded or without.
std::string StatedBypassContradiction(const model::Parameters& model, const runs::MeasuredRun& run);

}  // namespace hydro::diagnose
