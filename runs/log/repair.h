// hydro-log repair: keeps what is readable in a damaged log.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runs/log/log_verdict.h"
#include "runs/log/sound_events.h"

namespace hydro::log {

struct RepairResult {
  LogVerdict verdict;  // of the log as it was found
  int64_t kept_events = 0;
  int64_t kept_bytes = 0;
  int64_t check_bytes = 0;    // of sound check events, which are written again
  int64_t lost_messages = 0;  // messages that were written but are not kept, as far as the check events tell
  int64_t unvouched = 0;      // kept messages for which no checksum vouches
  std::vector<LostBytes> lost;  // in order of the file
  std::vector<int64_t>
      joined_at;        // bytes at which another recording begins that was joined to the one before
  std::string damaged;  // the name under which RepairInPlace() left the log as it was found
  std::string written;  // the log that was written; empty: none

  // Whether there was anything to mend: lost bytes, missing messages, or a missing mark of the end.
  bool mended() const;
};

// Finds the readable events of a log. A torn tail loses only the torn event, and damage in the middle loses
// only the events that it touches:
// - it drops bytes that are not an event, and events with a damaged length (sound_events.h);
// - it drops events whose checksum differs from when they were written (vouched_events.h);
// - it drops messages that are not what their channel holds, and those for which no checksum vouches and
// which
//   damage has changed by all appearances (doubtful_events.h).
//
// Throws InputError when the file cannot be read, has bytes but no event, or is of another kind. Unless `out`
// is empty, writes the events to that log, renumbered and with new checksums, whole or not at all; `out` may
// be the same file. A mended log records that it was mended and what it lacks (LogVerdict::note). Throws
// InputError or WriteError when that fails.
RepairResult RepairLog(const std::string& file, const std::string& out);

// Repairs a log in place and keeps the original as FILE.damaged, or FILE.damaged1 and so on where an earlier
// one has that name. Does not change a whole log, or one without checksums in which nothing is wrong. Throws
// WriteError and InputError, the latter also when the log is still being recorded.
RepairResult RepairInPlace(const std::string& file);

// One line for what was kept, and one line for each place where something was lost. `file` is the name by
// which the log was given.
std::string Describe(const RepairResult& result, const std::string& file);

}  // namespace hydro::log
