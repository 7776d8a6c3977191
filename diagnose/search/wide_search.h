// What was tried on windows and on whole runs, as a verdict reads it.
#pragma once

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
  // Whether windows decide, as they do wherever a set of changes could be proved.
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
  WindowTrials windows;  // empty where no windows can be cut
};

}  // namespace hydro::diagnose
