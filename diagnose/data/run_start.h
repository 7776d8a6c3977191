// Where a measured run begins.
#pragma once

#include "diagnose/data/run_data.h"

namespace hydro::diagnose {

// Sets the run's start, start_free and at_rest from its first samples; the rest of `data` must be filled in.
void SetStart(const model::Parameters& model, RunData* data);

}  // namespace hydro::diagnose
