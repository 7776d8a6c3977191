// Recordings that were joined end to end in one log: taken apart again, bit by bit.
#pragma once

#include <string>
#include <vector>

#include "runs/log/repair.h"

namespace hydro::log {

// One line on the recordings that were joined in a log, with the command that takes them apart; empty: the
// log is one recording. `file` holds the log as it was found.
std::string DescribeJoined(const RepairResult& result, const std::string& file);

// A recording that was taken out of a log.
struct JoinedPart {
  std::string file;
  LogVerdict verdict;
};

// Writes each recording that was joined in `file`, as it is there, to a log of its own: run-1.lcmlog,
// run-2.lcmlog of run.lcmlog, or of run.lcmlog.damaged. Throws InputError when the log is one recording or a
// file of such a name is there, before anything is written, and WriteError.
std::vector<JoinedPart> SplitJoined(const std::string& file);

}  // namespace hydro::log
