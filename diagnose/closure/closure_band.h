// How well a closure's values are known.
#pragma once

#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

// By how much the first step of a fit from where `fitted` stands would reduce its sum of squares, to first order.
double FirstStep(const Fitted& fitted);

// Sets the band of the closure's values from the fit to the windows: 95 % from the residuals that are left, counted by
// their autocorrelation. What the base model has wrong besides is not in it.
void SetBand(const Fitted& fitted, const std::vector<const RunData*>& windows, Closure* closure);

}  // namespace hydro::diagnose
