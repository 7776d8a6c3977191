// hydro-log repair: keeps what is readable in a damaged log.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hydro::log {

// Bytes of a log that were not kept.
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

// Finds the readable events of a log. A torn tail loses only the torn event, damage in the middle only the
// events that it touches:
// - after bytes that are no event, it looks for the next sync word that begins one;
// - it drops an event with a damaged length, which the bytes after or inside it reveal;
// - it drops an incomplete message on a channel of this stack if others on that channel are complete.
//
// Throws InputError when the file cannot be read, or has bytes but no event. Unless `out` is empty, writes
// the events to that log, renumbered, whole or not at all; `out` may be the same file. Throws InputError or
// WriteError when that fails.
RepairResult RepairLog(const std::string& file, const std::string& out);

// Repairs a log in place and keeps the original as FILE.damaged, which must not exist yet. Leaves a whole log
// alone. Throws WriteError, and InputError, also when the log is still being recorded.
RepairResult RepairInPlace(const std::string& file);

// One line for what was kept, and one for each place where something was lost.
std::string Describe(const RepairResult& result, const std::string& file);

}  // namespace hydro::log
