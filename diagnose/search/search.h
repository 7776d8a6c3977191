// The search for what a model lacks: adds effects and parameters while that predicts held-out runs materially
// better, then tries exchanging each for another and removing it.
#pragma once

#include <string>
#include <vector>

#include "diagnose/fit/hypothesis.h"
#include "diagnose/search/explanation.h"
#include "diagnose/search/race.h"

namespace hydro::diagnose {

struct Rated {
  Change change;
  // Fall of the squared gap that the score test of the given model expects.
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
// Above this squared gap on windows, no explanation reaches the noise on whole runs: a window's start is free.
inline constexpr double kOutOfReach = 2.5;

struct SearchOptions {
  int most_changes = kMostChanges;
  // Where the score test's likeliest changes do not explain the runs, more are refitted.
  bool thorough = true;
  // What the first changes have to come near in the race.
  Bar bar = {};
};

// Searches from `from`, without changes of its own and fitted.
SearchResult Search(const SearchContext& context, const Explanation& from, const SearchOptions& options = {});

}  // namespace hydro::diagnose
