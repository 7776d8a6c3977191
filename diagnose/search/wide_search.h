// A search from the model as given and, if that does not explain the runs, from the model with all of its own
// parameters refitted.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnose/search/search.h"

namespace hydro::diagnose {

// What was tried on windows, and the run of each window that it was not fitted to.
struct WindowTrials {
  std::vector<Explanation> tried;
  std::vector<std::string> runs;
};

struct WideSearch {
  SearchResult search;
  Explanation refit;     // the given model with all base parameters fitted that the runs identify
  WindowTrials windows;  // empty without a search on windows
};

// `allowed`: indices in BaseParameters() of those that may be refitted. If the given model cannot be simulated,
// `search.given` says so and the rest is empty.
WideSearch SearchWidely(const SearchContext& context, const Hypothesis& as_given,
                        const std::vector<size_t>& allowed);

}  // namespace hydro::diagnose
