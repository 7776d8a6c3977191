// Stretches of runs, each predicted from a start of its own. A prediction over a short time tells a missing
// effect from the drift that every small error of a model becomes over a whole run.
#pragma once

#include <vector>

#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// The run in stretches of `seconds`, one after the other, without a rest that is shorter. Each keeps the
// noise of the run's signals and its clock, begins where nearby samples say, and has that start open; a motor
// whose angle is not measured begins at the integral of its speed. The stretches of a driven shaft refer to
// `run`. Signals with too few values in a stretch are left out of it.
std::vector<RunData> WindowsOf(const RunData& run, double seconds, const model::Parameters& model);

// The same of several runs, run after run.
std::vector<RunData> WindowsOf(const std::vector<const RunData*>& runs, double seconds,
                               const model::Parameters& model);

// At most `most` of them, evenly spread, beginning with the one at `first`.
std::vector<const RunData*> EvenlySpread(const std::vector<RunData>& windows, size_t most, size_t first = 0,
                                         size_t stride = 1);

}  // namespace hydro::diagnose
