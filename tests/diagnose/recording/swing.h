// A second of a recording of Table 1's rig, without noise.
#pragma once

#include "model/terms/description.h"
#include "runs/measured/measured_run.h"

namespace hydro::testing {

model::ModelDescription Table1Model();

// At 1 kHz, driven to and fro, with all signals; the arm's only where it moves.
runs::MeasuredRun Swing(model::Shaft shaft, bool bypass = false);

}  // namespace hydro::testing
