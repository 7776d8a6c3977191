// What explains the runs as well as what was found.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnose/search/wide_search.h"

namespace hydro::diagnose {

struct Rival {
  std::string label;  // what stands in its place: "amp.delay", "parameter b", "parameters"
  const Explanation* explanation = nullptr;
};

// The explanations that do without `change`, one of the best one's, and cannot be told from it: they are not
// worse by 2.5 standard errors, block by block, and either exchange the change for one other and leave nearly
// the same gap, or have at least a fifth of the weight of the best claim or of the likeliest, whichever is less.
// They are compared on windows where these decide, else on whole runs.
std::vector<Rival> RivalsOf(const Change& change, const SearchResult& search, const Explanation& refit,
                            const WindowTrials& windows, const std::map<std::string, double>& weights);

}  // namespace hydro::diagnose
