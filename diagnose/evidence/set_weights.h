// How probable each explanation is: from tempered scores, drawn over runs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "diagnose/evidence/set_scan.h"

namespace hydro::diagnose {

struct WeighedExplanation {
  ChangeSet changes;  // without their variants
  ChangeSet set;      // the variants with most of the weight
  double weight = 0;
};

struct ExplanationWeights {
  std::vector<WeighedExplanation> explanations;  // those with a weight, largest first; they add up to 1
  size_t in_90 = 0;                              // how many of the first hold 90 % of the weight together
};

// Computes the weights of the sets in `scores`, and tries sets that are missing there. In each of 400 draws
// each run counts by a random factor, so that what a single run says weighs less than what all runs say. The
// finalists share each draw by their tempered scores. A set that adds changes to another set for hardly any
// gain is no explanation of its own: its weight goes to the other set. The result is the same for any number
// of jobs. `curves` says whether unknown curves take part.
ExplanationWeights WeighExplanations(SetScores* scores, uint64_t seed = 1, bool curves = true);

// Sorts the items that have a weight, largest first, and returns how many of the first hold 90 % together.
template <class Weighed>
size_t SortByWeight(std::vector<Weighed>* all) {
  std::ranges::stable_sort(*all, [](const Weighed& a, const Weighed& b) { return a.weight > b.weight; });
  double sum = 0;
  size_t in_90 = 0;
  while (in_90 < all->size() && sum < 0.9) sum += (*all)[in_90++].weight;
  return in_90;
}

}  // namespace hydro::diagnose
