// Runs the missing cases of a range on several threads.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "batch/study/study.h"

namespace hydro::batch {

struct RunProgress {
  int64_t to_run = 0;              // cases of the range that were not there
  int64_t ran = 0;                 // cases of those that have run
  int64_t failed = 0;              // of those that ran
  std::string first_failure = {};  // "case 3: reason", for the first that failed
  double elapsed_s = 0;
};

struct RunRequest {
  std::string folder;  // folder of the prepared study
  int64_t first = 0;   // the first case
  int64_t end = 0;     // the case after the last
  int jobs = 1;
  bool failed_again = false;        // failed cases count as missing
  std::function<bool()> stop = {};  // asked ten times a second and after each case, by any thread
  std::function<void(const RunProgress&)> progress = {};  // called ten times a second
};

struct RunOutcome {
  RunProgress progress;
  bool stopped = false;
};

// Runs every case of the range that is not stored, and stores it. Any number of processes on any hosts may do
// so in one folder at the same time, even for the same cases. A stored case is never lost. Throws StoreError
// when the folder or this machine's disk cannot be written; everything that ran before is stored.
RunOutcome RunCases(const Study& study, const RunRequest& request);

}  // namespace hydro::batch
