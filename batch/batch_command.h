// The request on the command line of hydro-batch.
#pragma once

#include <cstdint>
#include <string>

#include "batch/slurm_command.h"
#include "settings/command_line.h"

namespace hydro::batch {

// As many as this machine has processors, or the most that --jobs allows.
int64_t JobsOfThisMachine();

struct BatchOptions {
  std::string study;  // STUDY.toml
  std::string out;    // the study's folder; empty: out/batch/ and the name of the study's file
  int64_t jobs = JobsOfThisMachine();  // cases at the same time
  bool failed_again = false;
  std::string status;  // folder of a study whose status is shown
  std::string finish;  // folder of a study whose table is made
  std::string worker;  // folder of a prepared study whose cases are run
  std::string cases;   // "A:B", the cases to run
  SlurmOptions slurm;
};

void AddOptions(settings::CommandLine* line, BatchOptions* options);

// Returns the exit code: 0 all cases are done, 1 some failed or are missing. Throws InputError, StoreError,
// WriteError.
int Run(const BatchOptions& options);

}  // namespace hydro::batch
