// How well a model predicts short stretches of runs, at several horizons.
#pragma once

#include <array>
#include <vector>

#include "diagnose/data/run_data.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

// The horizons at which models are compared, in search horizons.
inline constexpr std::array<double, 3> kHorizonFactors = {0.25, 1.0, 4.0};

// The mean, over windows of a quarter, one and four times `seconds`, of the logarithm of the squared gap: what a model
// that is wrong is worth. Over a whole run its errors would add up to drift, and a few windows that start where
// friction holds the shaft would decide a mean of squares. The start of each window is fitted.
double HorizonScore(const model::ModelDescription& model, const std::vector<const RunData*>& runs,
                    double seconds, int jobs);

}  // namespace hydro::diagnose
