// The verdict on what was found, by the gaps that are left on held-out data.
#pragma once

#include "diagnose/evidence/set_scan.h"
#include "diagnose/prove/proof.h"
#include "diagnose/recording/diagnosis.h"
#include "diagnose/say/sentence.h"

namespace hydro::diagnose {

// The typical held-out gap over 0.4 s, or the horizon next to it that has one, where windows judged; else that of whole runs.
ComparedGap GapToCompare(const Diagnosis& d, const Proof& proof);

// Whether what was found predicts worse than the model as given. A gap that is not finite says nothing.
bool IsWorse(const BeforeAfter& gap);

// Whether the noise of all sensors is below 2e-4 of their range, as in a simulation: no model of a rig comes that near.
bool ExactSensors(const std::vector<const RunData*>& runs);

// `d` has the effects, parameters, closures and gaps. What was found was proved: it is named where the noise is left, tied where
// something does as well, and partly where more is left, or where a closure is a part of it. A gap that is left beside effects that
// simulation alone speaks for, though balances could (IsUnseenByBalances()), is unexplained: by weight or by `scores`, those of the balances
// with the best first, none of the effects has one in twenty, nor what they are tied with, unless other values do as well too. So are times of at most two samples (`sample`, s) that
// simulation alone speaks for: recorders make them.
Verdict VerdictOn(const Diagnosis& d, const Proof& proof, const std::vector<ScoredSet>& scores,
                  bool exact_sensors, double sample);

}  // namespace hydro::diagnose
