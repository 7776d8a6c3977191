// What was proved, in the form that a verdict needs.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "diagnose/fit/intervals.h"
#include "diagnose/prove/proof_context.h"
#include "diagnose/prove/proved_set.h"

namespace hydro::diagnose {

// The places of the sets that a verdict compares: the model as given, the best model with other values alone,
// and the best predictor.
struct ProofRoles {
  size_t given = 0, values = 0, best = 0;
};

struct Proof : ProofRoles {
  std::vector<ProvedSet> sets;
  // s, length of a judging window (ProvedSet::near); 0: the held-out runs themselves judge.
  double seconds = 0;
  // Whether nothing is missing because the values that predict whole runs best are those of the model as
  // given, in every digit that is shown.
  bool given_suffices = false;
  std::vector<std::string> runs;  // the run of each judging window
  // The best set fitted to windows of the fitted runs, or to these runs; it shows how well the set's numbers
  // are known. The fit fails where nothing can be simulated.
  Fitted told;
  std::shared_ptr<const std::vector<RunData>> windows;  // when it is not null, it owns:
  std::vector<const RunData*> told_runs;

  const ProvedSet& Given() const { return sets[given]; }
  const ProvedSet& Values() const { return sets[values]; }
  const ProvedSet& Best() const { return sets[best]; }
  const Hypothesis& Found() const { return Best().hypothesis; }
  // Whether windows judge. They do wherever one can be simulated; otherwise whole runs judge.
  bool OnWindows() const { return seconds > 0; }
};

// `told` has windows to which the values were fitted. Windows over which the best set cannot be simulated are
// left out.
Proof ProofOf(const ProofContext& context, const ProofWindows& windows, std::vector<RunData> told,
              std::vector<ProvedSet> sets, const ProofRoles& roles);

// 95 % intervals of the best set's free numbers, in the order of Hypothesis::Free(); NaN where they are not
// known.
std::vector<Interval> IntervalsOf(const ProofContext& context, const Proof& proof);

// Those effects of the best set that may be absent: 0 is within this part of the intervals of all their
// amounts; 0.51 is a standard deviation. Curves are not listed.
std::vector<Change> MayBeNone(const ProofContext& context, const Proof& proof, double part = 1);

}  // namespace hydro::diagnose
