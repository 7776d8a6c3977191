// Effects that a scan of balances cannot see. Only simulation can try them.
#pragma once

#include <vector>

#include "diagnose/prove/proof_context.h"
#include "diagnose/prove/proved_set.h"

namespace hydro::diagnose {

// Those of the context's changes that the catalogue marks so (EffectInfo::unseen_by_balances), where the runs
// can show them: with measured pressures, and for effects of an arm, with a free arm.
std::vector<Change> BlindChanges(const ProofContext& context);

// Adds the change to the set and fits it to `fitted` from each of the change's starts in the catalogue, with
// only the effect's numbers free. Returns the best of these fits, judged and refined. The result is not
// tested where no start can be fitted.
ProvedSet RacedFrom(const ProofContext& context, const std::vector<const RunData*>& fitted,
                    const ProofWindows& windows, const ProvedSet& set, const Change& change);

// Whether the runs' balances cannot speak for the effect, so that only simulation can name it.
bool IsUnseenByBalances(const std::string& effect);

}  // namespace hydro::diagnose
