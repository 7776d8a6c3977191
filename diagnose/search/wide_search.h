// A search from the model as given and, where its values are wrong too, from the model with all of its own
// parameters refitted.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "diagnose/search/search.h"

namespace hydro::diagnose {

// s. Long enough for the arm to move and the pressures to settle, short enough that drift does not drown what
// is missing. With 2 s, what differs from run to run drowned a laboratory drive's friction.
inline constexpr double kHorizon = 0.4;

// What was tried on windows, and the run of each window that it was not fitted to.
struct WindowTrials {
  std::vector<Explanation> tried;
  std::vector<std::string> runs;
  // Whether whole runs are so far from the noise that windows decide.
  bool decide = false;
  // The windows, and the fit of the best explanation to those that were fitted.
  std::shared_ptr<const std::vector<RunData>> all;
  std::vector<const RunData*> fitted, choosing;  // among `all`
  Fitted best;
};

struct WideSearch {
  SearchResult search;
  // The given model with all base parameters fitted, as far as what is known of them allows.
  Explanation refit;
  WindowTrials windows;  // empty without a search on windows
};

// `allowed`: indices in BaseParameters() of those that may be refitted. If the given model cannot be simulated,
// `search.given` says so and the rest is empty.
WideSearch SearchWidely(const SearchContext& context, const Hypothesis& as_given,
                        const std::vector<size_t>& allowed);

}  // namespace hydro::diagnose
