// Windows of runs in place of the runs.
#pragma once

#include <vector>

#include "diagnose/data/run_data.h"
#include "diagnose/search/wide_search.h"

namespace hydro::diagnose {

// s. How long windows are: 0.4 s, more where samples are slow, less in short runs.
double SearchHorizon(const std::vector<const RunData*>& runs);

// The context with windows in place of the runs: those that are fitted, and those that choose.
SearchContext OnWindows(const SearchContext& context, const std::vector<const RunData*>& fitted,
                        const std::vector<const RunData*>& choosing);

}  // namespace hydro::diagnose
