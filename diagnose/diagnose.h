// The gap finder: shows where a model and measured runs disagree, names what the model lacks, and closes the
// gap.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "diagnose/prove/progress.h"
#include "diagnose/recording/diagnosis.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

struct DiagnoseOptions {
  std::vector<std::string> effects;  // ids that may be named; empty: the whole catalogue
  // Base parameters that may be refitted; empty: all that the runs identify.
  std::vector<std::string> free;
  // Base parameters whose values belong to a run; empty: the parameter that differs most, if one does.
  std::vector<std::string> per_run;
  int jobs = 1;
  // s of processor time for each job. When it is used up, the search ends with what it has and the sentence
  // begins by saying so. Infinity: the search takes all the time it needs.
  double time_limit = std::numeric_limits<double>::infinity();
  uint64_t seed = 1;
};

// The `held_out` runs decide the verdict and are not fitted. When there are none, each run is held out in
// turn (the last third of a single run). Throws InputError for data that cannot be used, naming the run,
// signal and row, and ModelError when the given model cannot follow a run at all. The same arguments give the
// same diagnosis to the bit, whatever `jobs` is.
Diagnosis Diagnose(const model::ModelDescription& model, std::vector<runs::MeasuredRun> runs,
                   std::vector<runs::MeasuredRun> held_out, const DiagnoseOptions& options,
                   const ProgressCallback& report_progress);

}  // namespace hydro::diagnose
