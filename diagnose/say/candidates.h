// Every candidate, and why it was taken or rejected.
#pragma once

#include <string>
#include <vector>

#include "diagnose/evidence/set_scan.h"
#include "diagnose/prove/proof.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// Every single change, and every other set that has a weight or was proved. Taken ones first, then by weight and by held-out gap.
// Weights are those of the balances' explanations. `scores`: of sets, beyond that of nothing: the evidence for a set is so many times
// that for none, and chance alone gives as much at most once in so many times (Markov's inequality); where balances cannot speak,
// windows do, by their scatter. `d` has the verdict and the explanations: the model as given is taken only where nothing is missing.
std::vector<Candidate> CandidatesOf(const ProofContext& context, const Proof& proof, const Diagnosis& d,
                                    const std::vector<ScoredSet>& scores);

// What would be chosen without each run that was held out in turn: what was found, unless another set predicts the others better by
// what an effect has to take, or one without one of its effects as well. Empty with fewer than three runs, where what is left without
// one of them can choose nothing.
std::vector<ChoiceWithout> ChoicesWithoutEach(const Proof& proof);

}  // namespace hydro::diagnose
