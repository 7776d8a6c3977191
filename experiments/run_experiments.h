// What hydro-experiment does: runs experiments, writes their files, tells the results.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "experiments/report/experiment_request.h"
#include "experiments/studies/experiment.h"

namespace hydro::experiments {

// The experiments asked for. Throws InputError: no such name, or a measured run for one that takes none.
std::vector<Experiment> ChooseExperiments(const std::vector<Experiment>& all,
                                          const ExperimentRequest& request);

// Runs them, writes NAME.json, .csv, .svg for each and, for "all", index.html; then prints what came out, in
// the order of the report. Returns the exit code: 1 when one failed (the others are still run and the report
// names it) or, for "all", when a finding of kFindings has no evidence. Throws InputError when the folder
// cannot be created or written to, or, for a single experiment, when the measured run cannot be used.
int RunExperiments(const std::vector<Experiment>& all, const ExperimentRequest& request, std::FILE* out,
                   std::FILE* errors);

}  // namespace hydro::experiments
