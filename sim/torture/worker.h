// One process of a campaign: runs seeds and reports on a pipe what it finds.
#pragma once

#include <sys/types.h>

#include <cstdint>

#include "sim/torture/campaign.h"

namespace hydro::torture {

// What a worker and the campaign share in memory.
struct WorkerState {
  uint64_t seed = 0;    // that it runs now
  double began_s = 0;   // since the campaign began
  bool failed = false;  // a run has failed
};

// Runs every `jobs`-th seed until the time is over; writes to `pipe`. `states`: of all workers. Returns the worker's
// exit code.
int RunWorker(const CampaignOptions& options, int index, WorkerState* states, int pipe);

// The lines of a worker's report.
void AddReport(const std::string& text, CampaignResult* result);

}  // namespace hydro::torture
