// Runs with fewer samples, for fits that do not need them all.
#pragma once

#include <cstddef>

#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// Keeps every k-th sample of the run, so that neither its samples are closer than 1 ms nor fewer than `fewest` are
// left: a simulation stops at every sample, and far from the noise neighbours say the same, because their errors are
// those of the model. With 2 ms, a flexible arm was lost. The command counts by its mean over the samples in between;
// samples where it jumps are kept. A simulation of the run may take as many steps as before.
void Thin(size_t fewest, RunData* run);

// A copy that refers to the run's motion, without the measured run.
RunData ThinnedCopy(const RunData& run);

}  // namespace hydro::diagnose
