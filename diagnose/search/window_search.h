// The search on windows: which explanations predict short stretches of the runs best. It decides at any
// distance from the noise, and in a fraction of the time that whole runs take; whole runs are then the proof.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/data/run_data.h"
#include "diagnose/search/wide_search.h"

namespace hydro::diagnose {

// Windows cut from runs. Every other one is fitted, and the rest chooses between what was fitted.
struct SearchWindows {
  std::vector<RunData> all;
  std::vector<const RunData*> fitted, choosing;  // among `all`
};

// How long the windows of a search are: 0.4 s, more where samples are slow, less in short runs.
double SearchHorizon(const std::vector<const RunData*>& runs);
SearchWindows WindowsForSearch(const std::vector<const RunData*>& runs, const model::Parameters& model);

// The context with windows in place of the runs: those that are fitted, and those that choose.
SearchContext OnWindows(const SearchContext& context, const std::vector<const RunData*>& fitted,
                        const std::vector<const RunData*>& choosing);

// What is worth a trial on whole runs: the best explanation first, then what predicts the windows about as
// well, at most `most`.
std::vector<const Explanation*> Leading(const SearchResult& search, size_t most);

}  // namespace hydro::diagnose
