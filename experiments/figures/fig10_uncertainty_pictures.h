// Pictures of Figure 10's retuned step on drawn machines.
#pragma once

#include <vector>

#include "experiments/studies/experiment.h"
#include "experiments/studies/uncertain_machines.h"

namespace hydro::experiments {

// The distributions, their dependence on parameters, and the steps of single machines.
std::vector<Picture> UncertaintyPictures(const UncertainSteps& steps, const UncertainSpread& spread);

}  // namespace hydro::experiments
