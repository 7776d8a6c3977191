// What the balances of the runs propose: the likeliest sets of changes, as models that simulation can prove.
#pragma once

#include <string>
#include <vector>

#include "diagnose/evidence/set_weights.h"
#include "diagnose/prove/proof_context.h"
#include "diagnose/prove/proposal.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

struct Proposed {
  std::vector<Proposal> proposals;  // the likeliest first
  ExplanationWeights weights;       // of all sets that the balances tell apart
  // What the balances alone say of every set that was tried: score beyond that of nothing, best first.
  std::vector<ScoredSet> scores;
  // Of the base parameters that may differ, those that the runs show, and those by which their balances are measured.
  std::vector<size_t> shown;
  SaidByBalances said;
  std::vector<std::string>
      remarks;  // on signals that contradict each other, and effects that are doubles of values
  std::vector<Unjudged>
      unjudged;  // effects whose balances cannot be formed, because signals were not recorded
};

// `allowed`: base parameters that may differ, as in BaseParameters(). Nothing is simulated. Without a balance that can be formed there
// are no proposals.
// `inverted`: sensors whose readings have the wrong sign; every proposal then has the effect sensor.sign.
Proposed Propose(const ProofContext& context, const std::vector<size_t>& allowed,
                 const std::vector<std::string>& inverted = {});

}  // namespace hydro::diagnose
