// The experiments, each a function. Experiments() lists those that there are, with their titles.
#pragma once

#include "experiments/studies/experiment.h"

namespace hydro::experiments {

// In the order of the paper.
ExperimentResult RunFig1(const ExperimentOptions& options);      // apparatus.cc
ExperimentResult RunFriction(const ExperimentOptions& options);  // friction.cc
ExperimentResult RunLeakage(const ExperimentOptions& options);   // leakage.cc
ExperimentResult RunFig2(const ExperimentOptions& options);      // stick_slip.cc
ExperimentResult RunFig3(const ExperimentOptions& options);      // open_loop_step.cc
ExperimentResult RunFig4(const ExperimentOptions& options);      // square_wave_tracking.cc
ExperimentResult RunFig5(const ExperimentOptions& options);      // sine_tracking.cc
ExperimentResult RunFig6(const ExperimentOptions& options);      // figure6.cc
ExperimentResult RunFig7(const ExperimentOptions& options);      // figure7.cc
ExperimentResult RunWaves(const ExperimentOptions& options);     // line_waves.cc
ExperimentResult RunFig8(const ExperimentOptions& options);      // figure8.cc
ExperimentResult RunFig9(const ExperimentOptions& options);      // figure9.cc
ExperimentResult RunFig10(const ExperimentOptions& options);     // figure10.cc
ExperimentResult RunTorque(const ExperimentOptions& options);    // torque_control.cc

}  // namespace hydro::experiments
