// Finds the runs whose states a log holds: one, or several that were joined, merged or recorded together.
#pragma once

#include <cstdint>
#include <vector>

#include "base/input_error.h"
#include "runs/recorded/run_log.h"

namespace hydro::runs {

// The messages of one run.
struct SenderMessages {
  int64_t session = 0;  // of its plant or driver
  RunMessages messages;
};

// Whether there are states of several senders, or two different states of one tick.
bool HoldsSeveralRuns(const RunMessages& messages);

// Nobody joins more runs in one log. More senders of states are made up.
inline constexpr size_t kMostRuns = 100;

// The runs, in the order of their first states. A single run is returned as it is. A message of another
// process belongs to the run of its session, or else to the run that was recorded around its time. Empty
// where runs of one session are mixed and cannot be told apart, and where there are more than kMostRuns.
std::vector<SenderMessages> RunsIn(const RunMessages& messages);

// Throws InputError where a log, or a joint's part of it, holds several runs, because every figure would be a
// mean over all of them.
void RequireOneRun(const RunLog& log);
void RequireOneRun(const LimbLog& log);

}  // namespace hydro::runs
