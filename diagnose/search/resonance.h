// Frequencies of what resonates. A fit ends at the next of many frequencies at which a ringing is nearly in
// step with the measured one.
#pragma once

#include "diagnose/search/search.h"

namespace hydro::diagnose {

// `one`, fitted again from frequencies around its own for each of its free numbers that is in Hz, as long as
// that fits better. `one` itself where nothing is in Hz, or where it fits best already.
Explanation AtBestResonance(const SearchContext& context, const Explanation& one, const FitOptions& options);

}  // namespace hydro::diagnose
