// Fits where a run begins while the model is held. A slightly wrong start can be worse than a wrong
// parameter: friction or cogging then catches the shaft in another place.
#pragma once

#include <vector>

#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

// Above this squared gap, other starts of a run are tried too.
inline constexpr double kStartInDoubt = 1.1;

// Fits only the run's start, beginning at `from`. If that fails or leaves a squared gap above `doubtful`,
// also begins at the measured start and, where possible, at rest, and returns the best.
Fitted FitStart(const Hypothesis& hypothesis, const RunData& run, const model::StartState& from,
                double doubtful);

}  // namespace hydro::diagnose
