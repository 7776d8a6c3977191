// What the runs' balances propose: the likeliest sets of changes, as models that simulation can prove.
#pragma once

#include <string>
#include <vector>

#include "diagnose/evidence/set_weights.h"
#include "diagnose/prove/proof_context.h"
#include "diagnose/prove/proposal.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// Whether an effect of the set that can only add comes out negative in company with others, in all of its
// amounts. Where one of them does not (a seal's friction, beside what grows with the speed), the effect is
// possible, and the others are 0 in the model.
bool IsImpossible(const Rows& rows, const ChangeSet& set, const SetFit& fit);

struct Proposed {
  std::vector<Proposal> proposals;  // the likeliest first
  ExplanationWeights weights;       // of all sets that the balances distinguish
  // Every set that was tried, with its score above the empty set's by the balances alone, best first.
  std::vector<ScoredSet> scores;
  // Those of the base parameters that may differ which the runs show, and those in which their balances are
  // measured.
  std::vector<size_t> shown;
  SaidByBalances said;
  std::vector<std::string> remarks;  // on contradicting signals, and on effects that duplicate a value
  std::vector<Unjudged>
      unjudged;  // effects whose balances cannot be formed because signals were not recorded
};

// `allowed` lists base parameters that may differ, as in BaseParameters(). Nothing is simulated. If no
// balance can be formed, there are no proposals. `inverted` lists sensors whose readings have the wrong sign;
// every proposal then has the effect sensor.sign.
Proposed Propose(const ProofContext& context, const std::vector<size_t>& allowed,
                 const std::vector<std::string>& inverted = {});

// The model as given, with each predicted run's own value of a base parameter that may differ from day to day
// (ValuesOfADay()), as the run's balances show it. Its weight is that of this change alone in `proposed`.
Proposal WithOwnValues(const ProofContext& context, const std::vector<size_t>& allowed,
                       const std::string& parameter, const Proposed& proposed);

}  // namespace hydro::diagnose
