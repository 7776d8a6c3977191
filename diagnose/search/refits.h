// Which changes are refitted, and what remains of the refits.
#pragma once

#include <vector>

#include "diagnose/search/scan.h"

namespace hydro::diagnose {

// Whether both have the same changes, in whatever order and with whatever numbers.
bool SameChanges(const Hypothesis& a, const Hypothesis& b);

// How much of a score test is refitted.
struct RefitLimits {
  size_t changes = 0;  // the best so many
  size_t starts = 0;   // of each, from so many starting points
};

// Adds the most promising results of a score test of `from` to `pool`: the first few changes, each from its
// best starting points, as long as the test expects enough of them. Drops what failed from `scanned`, and
// puts the best first.
void Pick(const Fitted& from, const RefitLimits& limits, std::vector<std::vector<Scanned>>* scanned,
          std::vector<Scanned>* pool);

// The best fit of each set of changes, best first.
std::vector<Fitted> BestOfEach(std::vector<Fitted> fits);

}  // namespace hydro::diagnose
