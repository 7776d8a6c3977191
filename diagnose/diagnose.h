// The gap finder: where a model and measured runs disagree, what is missing, and the gap closed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/search/progress.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

struct DiagnoseOptions {
  std::vector<std::string> effects;  // ids that may be named; empty: the whole catalogue
  std::vector<std::string> free;  // base parameters that may be refitted; empty: all that the runs identify
  int jobs = 1;
  uint64_t seed = 1;
};

// `held_out` runs decide and are not fitted; when empty, the runs are held out in turn (the last third of a
// single one). Throws InputError for data that cannot be used, naming run, signal and row; ModelError when
// the given model cannot follow a run at all. The same arguments give the same diagnosis to the bit, whatever
// `jobs` is.
Diagnosis Diagnose(const model::ModelDescription& model, std::vector<runs::MeasuredRun> runs,
                   std::vector<runs::MeasuredRun> held_out, const DiagnoseOptions& options,
                   const TellProgress& tell);

}  // namespace hydro::diagnose
