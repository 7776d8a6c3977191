// Proofs with made-up gaps, for tests of what is concluded from them.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/prove/proof.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {

inline const diagnose::Change kLag{"amp.lag", {}, ""}, kDelay{"amp.delay", {}, ""},
    kRelief{"valve.relief", {}, ""}, kDrag{"pump.quadratic_drag", {}, ""};

// The model of Table 1 with these values free and these changes made.
inline diagnose::Hypothesis Freed(const std::vector<std::string>& base,
                                  std::vector<diagnose::Change> changes = {}) {
  diagnose::Hypothesis hypothesis = WithFree(Table1With(), base);
  hypothesis.changes = std::move(changes);
  return hypothesis;
}

// Leaves this squared gap of p1 in each of the windows, by a factor up and down in turn.
inline diagnose::ProvedSet Leaving(const std::vector<double>& gaps, diagnose::Hypothesis hypothesis,
                                   double by = 1) {
  diagnose::ProvedSet set;
  set.hypothesis = std::move(hypothesis);
  for (size_t w = 0; w < gaps.size(); ++w) {
    diagnose::WindowGap gap;
    gap.tested = true;
    gap.squared.fill(std::numeric_limits<double>::quiet_NaN());
    gap.squared[static_cast<size_t>(model::Channel::kP1)] = gaps[w] * (w % 2 == 0 ? by : 1 / by);
    gap.count = 100;
    gap.sum = 100 * gaps[w];
    set.near.push_back(gap);
  }
  set.far = set.near;
  return set;
}

// The same in each of 12 windows.
inline diagnose::ProvedSet Leaving(double gap, diagnose::Hypothesis hypothesis, double by = 1) {
  return Leaving(std::vector<double>(12, gap), std::move(hypothesis), by);
}

// Windows judged: four of each of three runs. The first set is the model as given, the second has other
// values, the last is best.
inline diagnose::Proof ProofOf(std::vector<diagnose::ProvedSet> sets) {
  diagnose::Proof proof;
  proof.sets = std::move(sets);
  proof.values = proof.sets.size() > 1 ? 1 : 0;
  proof.best = proof.sets.size() - 1;
  proof.seconds = 0.4;
  for (const char* run : {"a", "b", "c"}) proof.runs.insert(proof.runs.end(), 4, run);
  proof.told.failure = "made up";
  return proof;
}

}  // namespace hydro::testing
