// The verdict on what was found, from the gaps that remain on held-out data.
#pragma once

#include "diagnose/evidence/set_scan.h"
#include "diagnose/prove/proof.h"
#include "diagnose/recording/diagnosis.h"
#include "diagnose/say/sentence.h"

namespace hydro::diagnose {

// The typical held-out gap over 0.4 s, or over the nearest horizon that has one, where windows judged;
// otherwise the gap of whole runs.
ComparedGap GapToCompare(const Diagnosis& d, const Proof& proof);

// Whether the model that was found predicts worse than the model as given. A gap that is not finite says
// nothing.
bool IsWorse(const BeforeAfter& gap);

// Whether the noise of all sensors is below 2e-4 of their range, as in a simulation. No model of a real rig
// comes that close.
bool ExactSensors(const std::vector<const RunData*>& runs);

// What the verdict needs to know of the runs.
struct RunsJudged {
  bool exact_sensors = false;  // ExactSensors()
  double sample = 0;           // s, between samples
  double longest = 0;          // s, of a run
  double growth = 1;           // ErrorGrowth() over whole runs
};
RunsJudged JudgedBy(const std::vector<const RunData*>& runs, double growth);

// Whether all that was found are times of at most two samples for which only simulation speaks: means over a
// sample and filters of a recorder are as late, and balances allow for them. `scores` as below.
bool MayBeTheRecorders(const Diagnosis& d, const std::vector<ScoredSet>& scores, const RunsJudged& runs);

// `d` already has the effects, parameters, closures and gaps. All that was found was proved. The verdict is
// "named" where only noise is left, "tied" where an alternative does as well, and "partly" where more than
// noise is left or a closure is part of what was found. A remaining gap is "unexplained" where only
// simulation speaks for the effects although balances could (IsUnseenByBalances()): none of the effects, nor
// what they are tied with, has a probability of one in twenty, by weight or by `scores` (the balances' scores
// of sets, best first), unless other values do as well too. The same holds for times of at most two samples
// for which only simulation speaks (MayBeTheRecorders()), and for an effect whose amounts may all be 0 by
// their intervals, unless something is tied with it. "Nothing missing" allows whole runs to leave more than
// windows, in proportion to their length and to the growth of errors in them.
Verdict VerdictOn(const Diagnosis& d, const Proof& proof, const std::vector<ScoredSet>& scores,
                  const RunsJudged& runs);

}  // namespace hydro::diagnose
