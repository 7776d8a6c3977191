// Draws conclusions from a search: the verdict, ties, intervals and reasons.
#pragma once

#include "diagnose/data/diagnosis.h"
#include "diagnose/search/wide_search.h"

namespace hydro::diagnose {

// `refit`: the given model with all base parameters fitted. `windows`: what was tried on them.
Diagnosis Conclude(const SearchContext& context, const SearchResult& search, const Explanation& refit,
                   const WindowTrials& windows = {});

}  // namespace hydro::diagnose
