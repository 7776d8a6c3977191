// Starting points of a change that predict the runs best as they are, before any fit.
#pragma once

#include <vector>

#include "diagnose/search/explanation.h"
#include "diagnose/search/scan.h"

namespace hydro::diagnose {

// Those of `all`, hypotheses that differ in where a fit of `change` would begin, that predict a sample of the runs best from
// `starts`: at most `most`, the best first, none with a sum of squares above `limit` times that of `than`, a fit to the runs.
std::vector<Scanned> PredictingStarts(const SearchContext& context, const Change& change,
                                      const std::vector<Hypothesis>& all,
                                      const std::vector<model::StartState>& starts, const Fitted& than,
                                      size_t most, double limit);

}  // namespace hydro::diagnose
