// Every candidate with what became of it.
#pragma once

#include <vector>

#include "diagnose/diagnosis.h"
#include "diagnose/search.h"

namespace hydro {

// Taken ones first, then by held-out gap, fit and score.
std::vector<Candidate> Ranking(const SearchContext& context, const SearchResult& search);

}  // namespace hydro
