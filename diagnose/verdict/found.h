// What a search found, as a diagnosis states it: values with intervals, shares, weights and rivals.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/search/wide_search.h"

namespace hydro::diagnose {

// What is kept of the best explanation.
struct Kept {
  SearchResult search;
  std::vector<std::string> doubts;  // why its effects and values cannot be called the cause
};

// Where windows decide (WindowTrials::decide), the proof has tried to do without each effect; one that takes hardly any of the gap is
// dropped all the same. Else drops the effects of which there may be none (MayBeNone) as long as the rest explains the runs as well;
// those that are needed though the runs do not show that there is any of them are doubts.
Kept KeepWhatIsThere(const SearchContext& context, const SearchResult& search,
                     const WindowTrials& windows = {});

// The effects, the closures and the parameters of the best explanation. Returns it and its rivals, as models. Adds a doubt for
// each number that no rig has.
std::vector<model::ModelDescription> DescribeFound(const SearchContext& context, const Explanation& refit,
                                                   const WindowTrials& windows,
                                                   const std::map<std::string, double>& weights, Kept* kept,
                                                   Diagnosis* d);

}  // namespace hydro::diagnose
