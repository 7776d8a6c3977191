// Decides by exact simulation which proposal is reported: the one that predicts windows of held-out runs.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/prove/proof.h"
#include "diagnose/prove/proposal.h"

namespace hydro::diagnose {

// Simulates the model as given, the model with other values, and each proposal over windows of 0.4 s and 1.6
// s of the held-out runs (without held-out runs, over every other window of the runs), and chooses:
// - Values are those of the proposal or, where that predicts better, values refined by a few steps of a fit
//   to windows of the fitted runs.
// - An effect is kept only if the gap over 0.4 s is at least 10 % smaller with it than with the same set
//   without it (5 % where the balances of all runs give the effect odds of nine to one, `said`), and if the
//   gap over 1.6 s is not larger. Among sets that predict equally well, the one with fewer effects is chosen.
// - A set that cannot be simulated is "not tested": it is not chosen, and rules out nothing.
// `blind` has effects that a scan of balances cannot see (BlindChanges()). If the best proposal leaves a gap,
// each of them is added to it, fitted from its starts in the catalogue, and has to gain as much. `allowed`
// has indices in BaseParameters() of values that may be refitted; they are refitted if no proposal has other
// values alone.
//
// The number of windows, proposals and steps bounds the work, never the clock, so the result is the same for
// any number of jobs. If a model cannot follow a whole run, its windows still count.
Proof ProveProposals(const ProofContext& context, const Hypothesis& as_given,
                     const std::vector<size_t>& allowed, const std::vector<Proposal>& proposals,
                     const std::vector<Change>& blind = {}, const SaidByBalances& said = {});

}  // namespace hydro::diagnose
