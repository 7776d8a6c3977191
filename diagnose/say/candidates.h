// All candidates, with the reason why each was accepted or rejected.
#pragma once

#include <vector>

#include "diagnose/evidence/set_scan.h"
#include "diagnose/prove/proof.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// Every single change, and every other set that has a weight or was proved. Accepted ones come first, then
// the order is by weight and by held-out gap. Weights are those of the balances' explanations. `scores` are
// those of sets above the empty set's: the evidence for a set is exp(score) times that for the empty set, and
// chance alone gives as much at most once in that many cases (Markov's inequality). Where balances cannot
// speak, the scatter of the windows decides. `d` has the verdict and the explanations: the model as given is
// accepted only where nothing is missing.
std::vector<Candidate> CandidatesOf(const ProofContext& context, const Proof& proof, const Diagnosis& d,
                                    const std::vector<ScoredSet>& scores);

// What would be chosen without each run that was held out in turn. It is what was found, unless another set
// predicts the other runs better by what an effect has to gain, or a set without one of the effects predicts
// them as well. Empty with fewer than three runs, because the runs that remain without one of them cannot
// decide anything.
std::vector<ChoiceWithout> ChoicesWithoutEach(const Proof& proof);

}  // namespace hydro::diagnose
