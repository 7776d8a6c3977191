// A search from the model as given and, where its values are wrong too, from the model with all of its own
// parameters refitted.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "diagnose/search/search.h"

namespace hydro::diagnose {

// What was tried on windows, and the run of each window that it was not fitted to.
struct WindowTrials {
  std::vector<Explanation> tried;
  std::vector<std::string> runs;
  // Where whole runs are so far from the noise that windows decide: the windows that were fitted, and the fit of
  // the best explanation to them.
  bool decide = false;
  std::shared_ptr<const std::vector<RunData>> all;
  std::vector<const RunData*> fitted;  // among `all`
  Fitted best;
};

struct WideSearch {
  SearchResult search;
  // The given model with all base parameters fitted that the runs identify, as far as what is known of them
  // allows.
  Explanation refit;
  WindowTrials windows;  // empty without a search on windows
};

// `allowed`: indices in BaseParameters() of those that may be refitted. If the given model cannot be simulated,
// `search.given` says so and the rest is empty.
WideSearch SearchWidely(const SearchContext& context, const Hypothesis& as_given,
                        const std::vector<size_t>& allowed);

}  // namespace hydro::diagnose
