// How far a small error of a run's start is carried on.
#pragma once

#include <vector>

#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// The largest factor by which an error of the start of an angle or a speed grows in the prediction of that
// same signal over a whole run; at least 1. It is 1 for a machine that friction brings to rest and for an
// axis that integrates; a pendulum that passes its upper position has thousands. A run that the model cannot
// follow shows none.
double ErrorGrowth(const model::ModelDescription& model, const std::vector<const RunData*>& runs, int jobs);

}  // namespace hydro::diagnose
