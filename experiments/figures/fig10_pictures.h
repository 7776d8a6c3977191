// The pictures of Figure 10.
#pragma once

#include <vector>

#include "experiments/figures/fig10_runs.h"
#include "experiments/studies/experiment.h"

namespace hydro::experiments {

// The figure, the causes, the retuned loop, and that on other steps.
std::vector<Picture> Figure10Pictures(const Figure10Runs& figure);

}  // namespace hydro::experiments
