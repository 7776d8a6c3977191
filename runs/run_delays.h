// Brings channels that were recorded late onto the clock of the others.
#pragma once

#include <utility>
#include <vector>

#include "runs/measured_run.h"

namespace hydro::runs {

// A signal of a run and its delay in s; below 0 when it was recorded early.
using SignalDelay = std::pair<MeasuredSignal MeasuredRun::*, double>;

// Replaces each signal by its reading `delay` later, at the nearest sample, so that values and their noise
// stay as recorded. Cuts off the samples at the ends for which there is no such reading. Returns false, and
// leaves the run as it was, when fewer than two samples would remain.
bool RemoveDelays(const std::vector<SignalDelay>& delays, MeasuredRun* run);

}  // namespace hydro::runs
