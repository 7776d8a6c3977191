// How probable each explanation is: tempered scores, drawn over runs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "diagnose/evidence/set_scan.h"

namespace hydro::diagnose {

// What is wrong with all models here is alike in all rows, which the evidence takes for independent: measured on 63 rigs, a third of a
// difference in scores is worth what it says.
inline constexpr double kTemperature = 3;

struct WeighedExplanation {
  ChangeSet changes;  // without their variants
  ChangeSet set;      // the variants that have most of the weight
  double score = 0;   // of `set`
  double weight = 0;
};

struct ExplanationWeights {
  std::vector<WeighedExplanation> explanations;  // those with a weight, largest first; they add to 1
  size_t in_90 = 0;                              // how many of the first hold 90 % together
};

// The weights of the sets in `scores`; tries those that it lacks. In each of 400 draws each run counts by a
// random factor, so that what a single run says weighs less than what all say; the finalists share the draw
// by their tempered scores. What a set adds to another for hardly any gain is no explanation of its own: its
// weight is the other's. The same for any number of jobs.
// `curves`: whether unknown curves are among them.
ExplanationWeights WeighExplanations(SetScores* scores, uint64_t seed = 1, bool curves = true);

// Sorts what has a weight, the largest first; how many of the first hold 90 % together.
template <class Weighed>
size_t SortByWeight(std::vector<Weighed>* all) {
  std::stable_sort(all->begin(), all->end(),
                   [](const Weighed& a, const Weighed& b) { return a.weight > b.weight; });
  double sum = 0;
  size_t in_90 = 0;
  while (in_90 < all->size() && sum < 0.9) sum += (*all)[in_90++].weight;
  return in_90;
}

}  // namespace hydro::diagnose
