// The pictures of Figure 10.
#pragma once

#include <vector>

#include "experiments/figures/fig10_runs.h"
#include "experiments/studies/experiment.h"

namespace hydro::experiments {

// The figure, the causes of the difference, the retuned loop, and the retuned loop on other steps.
std::vector<Picture> Figure10Pictures(const Figure10Runs& figure);

}  // namespace hydro::experiments
