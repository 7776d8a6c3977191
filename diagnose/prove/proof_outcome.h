// What was proved, as the verdict reads it: explanations of windows, which decide, and of whole runs.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/prove/proved_set.h"
#include "diagnose/search/wide_search.h"

namespace hydro::diagnose {

// The places of what a verdict compares.
struct ProofRoles {
  size_t given = 0, values = 0, best = 0;
};

// `fitted`: windows as the values were fitted to them. Sets that cannot be tested are not among what was tried. A window that a set
// cannot be tested on counts as the model as given leaves it.
WideSearch OutcomeOf(const SearchContext& context, const ProofWindows& windows, std::vector<RunData> fitted,
                     const std::vector<ProvedSet>& sets, const ProofRoles& roles);

}  // namespace hydro::diagnose
