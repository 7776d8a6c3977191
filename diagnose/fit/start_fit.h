// Where a run begins, fitted while the model is held. A start that is a little wrong may be worse than a
// wrong number of the model: friction or cogging then catch the shaft at another place.
#pragma once

#include <vector>

#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

// From this squared gap on, a run's start is looked for elsewhere too.
inline constexpr double kStartInDoubt = 1.1;

// Only the run's start is fitted, begun at `from`. Where that fails, or leaves a squared gap above
// `doubtful`, also begun at the measured start, and at rest where that is possible; the best of them.
Fitted FitStart(const Hypothesis& hypothesis, const RunData& run, const model::StartState& from,
                double doubtful);

// Of each run, by FitStart; `from` where no simulation succeeds.
std::vector<model::StartState> BestStarts(const Hypothesis& hypothesis,
                                          const std::vector<const RunData*>& runs,
                                          const std::vector<model::StartState>& from, int jobs);

}  // namespace hydro::diagnose
