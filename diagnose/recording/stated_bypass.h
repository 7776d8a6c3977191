// Compares what a recording shows of the bypass with what its sidecar says about it.
#pragma once

#include <string>

#include "model/terms/terms.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

// The contradiction, with the line that corrects it; empty where there is none, or where the recording does
// not show the bypass. Closed oil is a spring between motor and arm, so the motor's torque shows whether the
// oil is closed, with or without recorded pressures.
std::string StatedBypassContradiction(const model::Parameters& model, const runs::MeasuredRun& run);

}  // namespace hydro::diagnose
