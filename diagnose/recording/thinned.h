// Runs with fewer samples, for fits that do not need all of them.
#pragma once

#include <cstddef>

#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// Keeps every k-th sample of the run, so that samples are at least 1 ms apart and at least `fewest` are left.
// A simulation stops at every sample, and far from the noise, neighbouring samples say the same because they
// share the model's error. With 2 ms, a flexible arm was lost. The command counts by its mean over the
// samples in between; samples where it jumps are kept. A simulation of the run may take as many steps as
// before.
void Thin(size_t fewest, RunData* run);

// A copy that refers to the run's motion but not to the measured run.
RunData ThinnedCopy(const RunData& run);

}  // namespace hydro::diagnose
