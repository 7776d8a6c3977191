// Aligns channels that were recorded late with the clock of the others.
#pragma once

#include <utility>
#include <vector>

#include "runs/measured_run.h"

namespace hydro::runs {

// A signal of a run and its delay in s, which is negative when it was recorded early.
using SignalDelay = std::pair<MeasuredSignal MeasuredRun::*, double>;

// Replaces each sample by the one `delay` later, rounded to the nearest sample, so that values and their
// noise stay as recorded. Cuts off samples at the ends that have no such reading. Returns false, and leaves
// the run unchanged, when fewer than two samples would remain.
bool RemoveDelays(const std::vector<SignalDelay>& delays, MeasuredRun* run);

}  // namespace hydro::runs
