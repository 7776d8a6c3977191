// hydro-batch --slurm: runs a study on a cluster.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "batch/study/study.h"
#include "settings/command_line.h"

namespace hydro::batch {

struct SlurmOptions {
  bool on = false;
  std::string partition, account, time;
  std::vector<std::string> sbatch;  // further arguments of sbatch
  int64_t at_once = 0;              // most jobs at the same time; 0: any number
  int64_t processors = 1;           // of one job
  int64_t cases_per_job = 0;        // 0: chosen automatically
  double case_s = 0;                // s that a case takes; 0: measured
  bool detach = false;
};

void AddSlurmOptions(settings::CommandLine* line, SlurmOptions* options);

// Throws InputError for options of --slurm without --slurm, and for values out of range.
void CheckSlurmOptions(const SlurmOptions& options);

enum class SlurmEnd {
  kEnded,  // all cases are there, or another attempt would be of no use
  kStopped,
};

// Runs the missing cases of a prepared study. The caller must hold its lock. With `failed_again`, failed
// cases count as missing. Throws InputError for what Slurm refuses, StoreError.
SlurmEnd RunOnSlurm(const Study& study, const std::string& folder, const SlurmOptions& options,
                    bool failed_again);

// A line about the jobs of a study that runs on a cluster; empty for other studies.
std::string SlurmStatusText(const std::string& folder);

}  // namespace hydro::batch
