// Every candidate, and why it was taken or rejected.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/search/wide_search.h"

namespace hydro::diagnose {

// Every single change, and every other explanation with a weight (evidence.h). Taken ones first, then by
// held-out gap and fit. `windows`: what was tried there is rejected for what it leaves of them.
std::vector<Candidate> Ranking(const SearchContext& context, const SearchResult& search,
                               const std::map<std::string, double>& weights, const WindowTrials& windows);

}  // namespace hydro::diagnose
