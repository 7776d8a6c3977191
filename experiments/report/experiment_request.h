// What the user asks hydro-experiment to do.
#pragma once

#include <string>

#include "experiments/studies/experiment.h"

namespace hydro::experiments {

struct ExperimentRequest {
  std::string name = "all";                // or an experiment's name
  std::string folder = "out/experiments";  // created if missing
  int jobs = 2;  // number of experiments that run at the same time, and of threads of one
  bool si = false;
  bool real_time = false;  // for the record only; options.run_stack decides
  ExperimentOptions options = {};
};

}  // namespace hydro::experiments
