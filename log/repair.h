// hydro-log repair: keeps what can be read of a damaged log.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hydro::log {

// Bytes of a log that are not kept.
struct LostBytes {
  int64_t begin = 0;
  int64_t end = 0;  // first byte after them
  std::string reason;
};

struct RepairResult {
  int64_t kept_events = 0;
  int64_t kept_bytes = 0;
  std::vector<LostBytes> lost;  // in order of the file; empty: the log is whole
};

// Finds the events of a log that can be read. A torn tail loses only the torn event, damage in the middle
// only the events that it touches:
// - after a place that is not an event, the next sync word that begins one is sought;
// - an event whose length is damaged, which shows by what follows it, or by the events that lie inside it, is
// not kept;
// - nor is an event on a channel of this stack that is not a whole message, if others on that channel are.
// Throws InputError when the file cannot be read or holds no event at all though it has bytes.
// With `out` not empty, writes them to that log, numbered anew, whole or not at all; it may be the same file.
// Throws InputError or WriteError when that fails.
RepairResult RepairLog(const std::string& file, const std::string& out);

// Repairs a log under its own name. What it was stays as FILE.damaged, which must not exist; a log that is
// whole is left alone. Throws InputError, also when the log is still being recorded; WriteError.
RepairResult RepairInPlace(const std::string& file);

// One line for what was kept, and one for each place where something was lost.
std::string Describe(const RepairResult& result, const std::string& file);

}  // namespace hydro::log
