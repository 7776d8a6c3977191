// How well a closure's values are known.
#pragma once

#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

// How far the base model's own values may move beside a closure: relative, a standard deviation.
inline constexpr double kNear = 0.3;

// By how much the first step of a fit from where `fitted` stands would reduce its sum of squares, to first order.
double FirstStep(const Fitted& fitted);

// Sets the band of the closure's values from the fit to the windows: 95 % from the residuals that are left, counted by
// their autocorrelation, with the model's own values free within kNear: a straight line in a curve over a speed is the
// same as another viscous friction. What the base model has wrong besides is not in it.
void SetBand(const Fitted& fitted, const std::vector<const RunData*>& windows, Closure* closure);

}  // namespace hydro::diagnose
