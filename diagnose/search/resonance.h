// Frequencies of resonances. A fit stops at the nearest of many frequencies at which a ringing is nearly in
// step with the measured one.
#pragma once

#include "diagnose/search/explanation.h"

namespace hydro::diagnose {

// Refits `one` from frequencies around its own, for each of its free numbers that is a frequency
// (Role::kFrequency), as long as that improves the fit. Returns `one` itself if it has no frequency or
// already fits best.
Explanation AtBestResonance(const SearchContext& context, const Explanation& one, const FitOptions& options);

}  // namespace hydro::diagnose
