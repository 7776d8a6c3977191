// Every candidate, and why it was taken or rejected.
#pragma once

#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/search/search.h"

namespace hydro::diagnose {

// Taken ones first, then by held-out gap, fit and score.
std::vector<Candidate> Ranking(const SearchContext& context, const SearchResult& search);

}  // namespace hydro::diagnose
