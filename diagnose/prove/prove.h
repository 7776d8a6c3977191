// Exact simulation decides which of the proposals is said: what predicts windows of runs that were held out.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/prove/proof.h"
#include "diagnose/prove/proposal.h"

namespace hydro::diagnose {

// Simulates the model as given, with other values, and each proposal over windows of 0.4 s and 1.6 s of the held-out runs (where
// none is held out, of every other window of the runs), and chooses:
// - values are those of the proposal or, where that predicts better, refined by a few steps of a fit to windows of the fitted runs;
// - an effect is kept only if the gap over 0.4 s is at least 10 % smaller with it than with the same set without it (5 % where the
//   balances of all runs say the effect at nine to one, `said`), and the gap over 1.6 s is not larger; among sets that predict equally well, the one with fewer effects is chosen;
// - what cannot be simulated is "not tested": it is not chosen, and rules out nothing.
// `blind`: effects that a scan of balances cannot see (BlindChanges()). Where the best proposal leaves a gap, each is added to it,
// fitted from its starts in the catalogue, and has to gain as much.
// `allowed`: indices in BaseParameters() of those that may be refitted; they are where no proposal has other values alone.
//
// The work is bounded by the number of windows, proposals and steps, never by the clock; the same for any number of jobs. Where a
// model cannot follow a whole run, its windows still count.
Proof ProveProposals(const ProofContext& context, const Hypothesis& as_given,
                     const std::vector<size_t>& allowed, const std::vector<Proposal>& proposals,
                     const std::vector<Change>& blind = {}, const SaidByBalances& said = {});

}  // namespace hydro::diagnose
