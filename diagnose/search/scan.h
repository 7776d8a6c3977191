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
  Hypothesis start;     // with the change, its parameters moved to where the score test expects them
  double expected = 0;  // fall of the sum of squared residuals that it expects
  std::string failure;  // "" or why it cannot be judged
  // Where the runs begin with it; empty: where they do without it.
  std::vector<model::StartState> run_starts;
};

// One row for each change and starting point, best first within each change. The change's derivatives are
// projected off those of all that `current` has free and of the runs' starts.
std::vector<std::vector<Scanned>> Scan(const Fitted& current, const std::vector<const RunData*>& runs,
                                       const std::vector<Change>& changes, const Sizes& sizes, bool elsewhere,
                                       int jobs);

}  // namespace hydro::diagnose
