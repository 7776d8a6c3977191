// Draws conclusions from a search: the verdict, ties, intervals and reasons.
#pragma once

#include "diagnose/data/diagnosis.h"
#include "diagnose/search/search.h"

namespace hydro::diagnose {

// `refit`: the given model with all identifiable base parameters fitted.
Diagnosis Conclude(const SearchContext& context, const SearchResult& search, const Explanation& refit);

}  // namespace hydro::diagnose
