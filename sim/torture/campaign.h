// Many runs on several processors, each from a seed of its own.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "sim/torture/invariants/coverage.h"
#include "sim/torture/invariants/observer.h"
#include "sim/torture/schedule/schedule.h"

namespace hydro::torture {

struct CampaignOptions {
  uint64_t first_seed = 1;
  double seconds = 60;               // of wall time
  int64_t most_runs = 0;             // 0: as many as there is time for
  int jobs = 1;                      // processes that run at the same time
  std::string config;                // a stack of the user's own; empty: the shipped one
  std::string out;                   // folder for the schedules that fail
  bool first_only = false;           // the first run that fails ends the campaign
  std::vector<std::string> without;  // kinds of faults that are not injected
};

// A schedule that fails, shrunk. Runs that fail alike count once.
struct Finding {
  uint64_t seed = 0;
  double after_s = 0;  // wall time since the campaign began
  Violation violation;
  Schedule schedule;
  std::string file;  // its script; empty if it could not be shrunk
};

struct CampaignResult {
  Coverage coverage;
  std::vector<Finding> findings;
  int64_t failed_runs = 0;
  double wall_s = 0;
  double cpu_s = 0;  // summed over all processors
};

// Runs the seeds from the first one on. A run that crashes this program, or does not end, also becomes a
// finding. Throws InputError when the folder cannot be written.
CampaignResult RunCampaign(const CampaignOptions& options);

// The memory that a worker shares with the campaign.
struct WorkerState {
  uint64_t seed = 0;    // of the current run
  double began_s = 0;   // start of that run, since the campaign began
  bool failed = false;  // a run has failed
};

// One process of a campaign: runs every `jobs`-th seed until the time is over, and writes to `pipe`. `states`
// are those of all workers. Returns the worker's exit code.
int RunWorker(const CampaignOptions& options, int index, WorkerState* states, int pipe);

// Adds the lines of a worker's report to `result`.
void AddReport(const std::string& text, CampaignResult* result);

}  // namespace hydro::torture
