// Explanations with made-up gaps, for tests of what is concluded from them.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "diagnose/search/explanation.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {

// The model of Table 1 with these values free and these changes made.
inline diagnose::Hypothesis Freed(const std::vector<std::string>& base,
                                  std::vector<diagnose::Change> changes = {}) {
  diagnose::Hypothesis hypothesis = WithFree(Table1With(), base);
  hypothesis.changes = std::move(changes);
  return hypothesis;
}

// Leaves this squared gap in each of ten blocks of whole runs, or in each of ten windows.
inline diagnose::Explanation Leaving(double gap, diagnose::Hypothesis hypothesis, bool windows) {
  diagnose::Explanation one;
  one.fitted.hypothesis = std::move(hypothesis);
  one.fitted.sum = 1000 * gap;
  one.fitted.count = 1000;
  one.windows = windows;
  one.held_out.gaps.assign(10, gap);
  one.held_out.count = 1000;
  one.held_out.sum = 1000 * gap;
  one.blocks.sums.assign(10, windows ? std::log(gap) : 100 * gap);
  one.blocks.count = 1000;
  return one;
}

// The same, with gaps that scatter around it: by this factor up and down in turn.
inline diagnose::Explanation Scattered(double gap, double by, diagnose::Hypothesis hypothesis,
                                       bool windows = true) {
  diagnose::Explanation one = Leaving(gap, std::move(hypothesis), windows);
  for (size_t b = 0; b < one.blocks.sums.size(); ++b) {
    const double factor = b % 2 == 0 ? by : 1 / by;
    one.blocks.sums[b] = windows ? std::log(gap * factor) : 100 * gap * factor;
  }
  return one;
}

inline const diagnose::Change kLag{"amp.lag", {}, ""}, kDelay{"amp.delay", {}, ""},
    kRelief{"valve.relief", {}, ""};

}  // namespace hydro::testing
