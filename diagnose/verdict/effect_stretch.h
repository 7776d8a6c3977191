// Where in the runs an effect shows most: for effects that act through time.
#pragma once

#include <optional>

#include "diagnose/data/diagnosis.h"
#include "diagnose/search/explanation.h"

namespace hydro::diagnose {

// The stretch of a run, a 25th of it, and the signal in which the best explanation's model differs most in noise
// units from the same model without `effect`. Among the fitted runs; nothing if they do not differ or one of the
// two cannot be simulated.
std::optional<FoundStretch> StretchOf(const SearchContext& context, const Explanation& best,
                                      const std::string& effect);

}  // namespace hydro::diagnose
