// Channels of a recording that are late against the others: put on one clock.
#pragma once

#include <utility>
#include <vector>

#include "runs/measured_run.h"

namespace hydro::runs {

// A signal of a run and by how much it was recorded late, s (early: below 0).
using SignalDelay = std::pair<MeasuredSignal MeasuredRun::*, double>;

// Every such signal is replaced by what it read `delay` later, at the nearest sample: values stay as they
// were recorded, so that their noise does too. Samples for which there is no such reading are cut off the
// ends. False, and the run as it was, when fewer than two samples would be left.
bool RemoveDelays(const std::vector<SignalDelay>& delays, MeasuredRun* run);

}  // namespace hydro::runs
