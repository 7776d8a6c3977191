// What was proved, as a verdict reads it.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "diagnose/fit/intervals.h"
#include "diagnose/prove/proof_context.h"
#include "diagnose/prove/proved_set.h"

namespace hydro::diagnose {

struct Proof {
  std::vector<ProvedSet> sets;
  // Their places: the model as given, that with other values alone, and what predicts best.
  size_t given = 0, values = 0, best = 0;
  // s, that a judging window (ProvedSet::near) reaches; 0: the held-out runs themselves judge.
  double seconds = 0;
  std::vector<std::string> runs;  // that each judging window is from
  // The best set fitted to windows of the fitted runs, or to these: how well its numbers are known. Fails where nothing can be
  // simulated.
  Fitted told;
  std::shared_ptr<const std::vector<RunData>> windows;  // owns, where it is not null:
  std::vector<const RunData*> told_runs;

  const ProvedSet& Given() const { return sets[given]; }
  const ProvedSet& Values() const { return sets[values]; }
  const ProvedSet& Best() const { return sets[best]; }
  const Hypothesis& Found() const { return Best().hypothesis; }
  // Whether windows judge, as they do wherever one can be simulated; else whole runs.
  bool OnWindows() const { return seconds > 0; }
};

// The places of what a verdict compares.
struct ProofRoles {
  size_t given = 0, values = 0, best = 0;
};

// `told`: windows as the values were fitted to them. Those that the best set cannot be simulated over are left out.
Proof ProofOf(const ProofContext& context, const ProofWindows& windows, std::vector<RunData> told,
              std::vector<ProvedSet> sets, const ProofRoles& roles);

// 95 % intervals of the best set's free numbers, in the order of Hypothesis::Free(); NaN where they are not known.
std::vector<Interval> IntervalsOf(const ProofContext& context, const Proof& proof);

// The effects of the best set that may as well be none: the intervals of all their amounts hold 0. Not of curves.
std::vector<Change> MayBeNone(const ProofContext& context, const Proof& proof);

}  // namespace hydro::diagnose
