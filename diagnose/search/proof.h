// The search and its proof: windows choose, whole runs prove.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnose/search/wide_search.h"

namespace hydro::diagnose {

// Searches on windows (window_search.h), fits what leads there to the whole runs, and predicts those held out.
// Where that does not reach the noise although windows come near it, searches on from there on the whole runs:
// what is small or slow shows only over long times. `allowed` as in SearchWidely.
WideSearch SearchAndProve(const SearchContext& context, const Hypothesis& as_given,
                          const std::vector<size_t>& allowed);

// What keeps the held-out gap from being a proof: predictions that are reported as held out also chose. Empty where they did not.
std::string ProofRemark(const SearchContext& context);

}  // namespace hydro::diagnose
