// The experiments, one function each. Experiments() lists them with their titles.
#pragma once

#include "experiments/studies/experiment.h"

namespace hydro::experiments {

// In the paper's order.
ExperimentResult RunFig1(const ExperimentOptions& options);
ExperimentResult RunFriction(const ExperimentOptions& options);
ExperimentResult RunLeakage(const ExperimentOptions& options);
ExperimentResult RunFig2(const ExperimentOptions& options);
ExperimentResult RunFig3(const ExperimentOptions& options);
ExperimentResult RunFig4(const ExperimentOptions& options);
ExperimentResult RunFig5(const ExperimentOptions& options);
ExperimentResult RunFig6(const ExperimentOptions& options);
ExperimentResult RunFig7(const ExperimentOptions& options);
ExperimentResult RunWaves(const ExperimentOptions& options);
ExperimentResult RunFig8(const ExperimentOptions& options);
ExperimentResult RunFig9(const ExperimentOptions& options);
ExperimentResult RunFig10(const ExperimentOptions& options);
ExperimentResult RunFig10Uncertainty(const ExperimentOptions& options);
ExperimentResult RunTorque(const ExperimentOptions& options);
ExperimentResult RunCoupling(const ExperimentOptions& options);

}  // namespace hydro::experiments
