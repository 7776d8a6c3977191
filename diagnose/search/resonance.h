// Frequencies of what resonates. A fit ends at the nearest of many frequencies at which a ringing is nearly
// in step with the measured one.
#pragma once

#include "diagnose/search/search.h"

namespace hydro::diagnose {

// `one`, fitted again from frequencies around its own for each of its free numbers that is one
// (Role::kFrequency), as long as that fits better. `one` itself where none is, or where it already fits best.
Explanation AtBestResonance(const SearchContext& context, const Explanation& one, const FitOptions& options);

}  // namespace hydro::diagnose
