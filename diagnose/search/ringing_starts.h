// Resonances at the frequencies at which the runs ring.
#pragma once

#include <vector>

#include "diagnose/search/explanation.h"
#include "diagnose/search/scan.h"

namespace hydro::diagnose {

// The resonances among `changes`, added to `from` at the context's ringing frequencies: of each frequency the
// few starting points that predict a sample of the runs best. The score test, which is linear, prefers others. Empty where nothing rings.
std::vector<Scanned> RingingStarts(const SearchContext& context, const Fitted& from,
                                   const std::vector<Change>& changes);

}  // namespace hydro::diagnose
