// Stretches of runs, each predicted from its own start. Over a whole run every small error of a model grows
// into a drift; a prediction over a short time distinguishes a missing effect from that drift.
#pragma once

#include <vector>

#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// Cuts the run into consecutive stretches of `seconds`; a shorter rest is dropped. Each stretch keeps the
// noise of the run's signals and its clock. It begins where nearby samples say, with that start left open; a
// motor whose angle is not measured begins at the integral of its speed. The stretches of a driven shaft
// refer to `run`. A signal with too few values in a stretch is left out of it.
std::vector<RunData> WindowsOf(const RunData& run, double seconds, const model::Parameters& model);

// The same for several runs, one after the other.
std::vector<RunData> WindowsOf(const std::vector<const RunData*>& runs, double seconds,
                               const model::Parameters& model);

// At most `most` windows, evenly spread, beginning with the one at `first`.
std::vector<const RunData*> EvenlySpread(const std::vector<RunData>& windows, size_t most, size_t first = 0,
                                         size_t stride = 1);

}  // namespace hydro::diagnose
