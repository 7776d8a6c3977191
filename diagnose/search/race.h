// The race between changes: all are fitted a little, those that lead are fitted on.
#pragma once

#include <vector>

#include "diagnose/search/explanation.h"
#include "diagnose/search/scan.h"

namespace hydro::diagnose {

// What a fit has to come near to stay in a race.
struct Bar {
  const Fitted* rival = nullptr;  // of the same runs; null: there is none
  double times = 1;               // its sum of squares
};

// What a race ended with, in the order of its pool.
struct RaceResult {
  std::vector<Fitted> leading;  // fitted to all windows
  // Left behind, or ended by the time limit, after the fit to the sample: their sums of squares are scaled to all windows, and they
  // have the sample's starts.
  std::vector<Fitted> behind;
  std::vector<Fitted> failed;  // or not begun within the time limit
};

// Fits all of `pool` with a few of the options' iterations, of windows to a sample of them, and those that then lead with the
// rest. `starts`: of each run, where an entry of the pool has none of its own.
RaceResult Race(const SearchContext& context, const std::vector<Scanned>& pool,
                const std::vector<model::StartState>& starts, const FitOptions& options, const Bar& bar);

// Which of `runs` windows a race begins with: a third of them, evenly spread, and the last few. All of a few.
std::vector<size_t> RaceSample(size_t runs);

// Which of the fits go on: those near the best one and with a sum of squares of at most `most`, at most four, and of one
// change's starts the best.
std::vector<bool> InTheRace(const std::vector<Fitted>& fits, double most);

}  // namespace hydro::diagnose
