// Figure 10's retuned step on drawn machines, in pictures.
#pragma once

#include <vector>

#include "experiments/studies/experiment.h"
#include "experiments/studies/uncertain_spread.h"

namespace hydro::experiments {

// The distributions; what they depend on; the steps of single machines.
std::vector<Picture> UncertaintyPictures(const UncertainSteps& steps, const UncertainSpread& spread);

}  // namespace hydro::experiments
