// Effects that a scan of balances cannot see, and that only simulation can try.
#pragma once

#include <vector>

#include "diagnose/prove/proved_set.h"
#include "diagnose/search/explanation.h"

namespace hydro::diagnose {

// Among the context's changes: an arm that gives, where one is free (its own angle is not measured); valves that regulate a pressure
// (the flow balance is an inequality there); breakaway (while the shaft sticks its balance says nothing); an accumulator whose
// pressure moves (what it has taken in is not measured).
std::vector<Change> BlindChanges(const SearchContext& context);

// The set with the change added, fitted to `fitted` from each of the change's starts in the catalogue, with the effect's numbers
// alone free; the best of these, judged and refined. Not tested where no start can be fitted.
ProvedSet RacedFrom(const SearchContext& context, const std::vector<const RunData*>& fitted,
                    const ProofWindows& windows, const ProvedSet& set, const Change& change);

}  // namespace hydro::diagnose
