// The experiments, each a function. Experiments() lists those that there are, with their titles.
#pragma once

#include "experiments/experiment.h"

namespace hydro {

// In the order of the paper.
ExperimentResult RunFig1(const ExperimentOptions& options);      // apparatus.cc
ExperimentResult RunFriction(const ExperimentOptions& options);  // friction.cc
ExperimentResult RunFig2(const ExperimentOptions& options);      // stick_slip.cc
ExperimentResult RunFig3(const ExperimentOptions& options);      // open_loop_step.cc
ExperimentResult RunFig4(const ExperimentOptions& options);      // square_wave_tracking.cc
ExperimentResult RunFig5(const ExperimentOptions& options);      // sine_tracking.cc
ExperimentResult RunFig8(const ExperimentOptions& options);      // figure8.cc
ExperimentResult RunFig9(const ExperimentOptions& options);      // figure9.cc

}  // namespace hydro
