// Where the gap is when no balance shows it.
#pragma once

#include <vector>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// Where no balance shows anything, or none can be formed: the signal with the largest part of the squared gap, in noise units,
// under its own name, and the stretches where it is predicted worst. `after`: with what was found, instead of the model as
// given. Empty where no signal is beyond its noise.
std::vector<Location> WorstSignal(const std::vector<SignalGap>& signals, const std::vector<RunCurves>& curves,
                                  bool after);

}  // namespace hydro::diagnose
