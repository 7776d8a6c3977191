// Draws conclusions from what was tried: the verdict, ties, intervals and reasons.
#pragma once

#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/search/wide_search.h"

namespace hydro::diagnose {

// `found`: what was tried on windows and on whole runs. `explanations`: what the balances say of sets of changes.
Diagnosis Conclude(const SearchContext& context, const WideSearch& found,
                   const std::vector<WeightedSet>& explanations = {});

}  // namespace hydro::diagnose
