// What was asked of hydro-experiment.
#pragma once

#include <string>

#include "experiments/studies/experiment.h"

namespace hydro::experiments {

struct ExperimentRequest {
  std::string name = "all";                // or of an experiment
  std::string folder = "out/experiments";  // is created
  int jobs = 2;                            // experiments at the same time
  bool si = false;
  bool real_time = false;  // for the record; options.run_stack says how
  ExperimentOptions options = {};
};

}  // namespace hydro::experiments
