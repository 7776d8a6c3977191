// The work of hydro-experiment: runs experiments, writes their files, prints the results.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "experiments/report/experiment_files.h"
#include "experiments/studies/experiment.h"

namespace hydro::experiments {

// Selects the requested experiments. Throws InputError for an unknown name, for a measured run given to an
// experiment that takes none, or for a number of machines given to one that draws none.
std::vector<Experiment> ChooseExperiments(const std::vector<Experiment>& all,
                                          const ExperimentRequest& request);

// Runs the experiments, writes NAME.json, .csv and .svg for each and, for "all", index.html; then prints the
// results in the report's order. Returns exit code 1 when an experiment failed (the others still run, and the
// report names it) or, for "all", when one of the kFindings findings has no evidence. Throws InputError when
// the folder cannot be created or written, or, for a single experiment, when the measured run cannot be used.
int RunExperiments(const std::vector<Experiment>& all, const ExperimentRequest& request, std::FILE* out,
                   std::FILE* errors);

}  // namespace hydro::experiments
