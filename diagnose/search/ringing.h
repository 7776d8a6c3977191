// Frequencies at which pressures ring although the model's do not.
#pragma once

#include <vector>

#include "diagnose/data/run_data.h"
#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

// Where the spectrum of the pressures' residuals has its clearest peaks, in Hz, the clearest first, at most three: starting
// values for resonances, which a fit does not find from a fifth away. Empty where the runs have no pressures or show no peak.
std::vector<double> RingingFrequencies(const Fitted& fitted, const std::vector<const RunData*>& runs,
                                       int jobs);

}  // namespace hydro::diagnose
