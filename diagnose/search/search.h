// What a search tries and finds.
#pragma once

#include <string>
#include <vector>

#include "diagnose/fit/hypothesis.h"
#include "diagnose/search/explanation.h"

namespace hydro::diagnose {

struct Rated {
  Change change;
  // By how much the typical held-out gap falls with the change alone, in noise units squared; 0 where it was not proposed.
  double expected = 0;
  std::string failure;  // why it cannot be simulated
};

// Everything that was tried.
struct SearchResult {
  Explanation given;
  std::vector<Rated> rated;        // all single changes to the given model
  std::vector<Explanation> tried;  // all that were fitted, in the order of trying
  Explanation best;
};

// The most changes that are made to a model.
inline constexpr int kMostChanges = 3;
// Below this squared gap on held-out runs, nothing is left to search for.
inline constexpr double kCloseEnough = 1.25;

}  // namespace hydro::diagnose
