// The score test: what each change to a hypothesis would gain, judged from derivatives at a starting point,
// before anything is refitted.
#pragma once

#include <string>
#include <vector>

#include "diagnose/fit/fit.h"
#include "diagnose/fit/hypothesis.h"

namespace hydro::diagnose {

struct Scanned {
  Change change;
  Hypothesis start;     // with the change, moved to where the score test expects it
  double expected = 0;  // fall of the sum of squared residuals
  std::string failure;  // why it cannot be judged, or ""
  // Where the runs begin with the change; empty: where they begin without it.
  std::vector<model::StartState> run_starts;
};

// One row for each change and starting point, best first within each change. The change's derivatives are
// projected off those of everything that is free in `current` and of the runs' starts.
std::vector<std::vector<Scanned>> Scan(const Fitted& current, const std::vector<const RunData*>& runs,
                                       const std::vector<Change>& changes, const Sizes& sizes, bool elsewhere,
                                       int jobs);

}  // namespace hydro::diagnose
