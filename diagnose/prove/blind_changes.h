// Effects that a scan of balances cannot see, and that only simulation can try.
#pragma once

#include <vector>

#include "diagnose/prove/proof_context.h"
#include "diagnose/prove/proved_set.h"

namespace hydro::diagnose {

// Among the context's changes those that say so in the catalogue (EffectInfo::unseen_by_balances), where runs can show them: with
// pressures measured, and of an arm where one is free.
std::vector<Change> BlindChanges(const ProofContext& context);

// The set with the change added, fitted to `fitted` from each of the change's starts in the catalogue, with the effect's numbers
// alone free; the best of these, judged and refined. Not tested where no start can be fitted.
ProvedSet RacedFrom(const ProofContext& context, const std::vector<const RunData*>& fitted,
                    const ProofWindows& windows, const ProvedSet& set, const Change& change);

// Whether the balances of the runs cannot speak for the effect: simulation alone names it.
bool IsUnseenByBalances(const std::string& effect);

}  // namespace hydro::diagnose
