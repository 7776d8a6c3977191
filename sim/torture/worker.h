// One process of a campaign. It runs seeds and reports its findings on a pipe.
#pragma once

#include <sys/types.h>

#include <cstdint>

#include "sim/torture/campaign.h"

namespace hydro::torture {

// The memory that a worker shares with the campaign.
struct WorkerState {
  uint64_t seed = 0;    // of the current run
  double began_s = 0;   // start of that run, since the campaign began
  bool failed = false;  // a run has failed
};

// Runs every `jobs`-th seed until the time is over, and writes to `pipe`. `states` are those of all workers.
// Returns the worker's exit code.
int RunWorker(const CampaignOptions& options, int index, WorkerState* states, int pipe);

// Adds the lines of a worker's report to `result`.
void AddReport(const std::string& text, CampaignResult* result);

}  // namespace hydro::torture
