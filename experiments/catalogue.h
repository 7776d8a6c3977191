// The experiments, each a function. Experiments() lists those that there are, with their titles.
#pragma once

#include "experiments/experiment.h"

namespace hydro {

// In the order of the paper.
ExperimentResult RunFig2(const ExperimentOptions& options);  // stick_slip.cc
ExperimentResult RunFig3(const ExperimentOptions& options);  // open_loop_step.cc
ExperimentResult RunFig4(const ExperimentOptions& options);  // square_wave_tracking.cc
ExperimentResult RunFig5(const ExperimentOptions& options);  // sine_tracking.cc

}  // namespace hydro
