// Writes a window of a run as a file.
#pragma once

#include <optional>
#include <string>

#include "scope/signals/run.h"

namespace hydro::scope {

// The parts of a run that are needed to cut a window out of it on another thread.
struct CutSource {
  std::optional<MessageStore::Snapshot> messages;  // of a live run; otherwise the log is the source
  std::string log_file;
  std::string name;
  std::string suffix;
  int64_t session = 0;
};

CutSource CutSourceOf(const Run& run);

// Writes the messages of [t0, t1] (s of plant time) as a log, with its description. Throws InputError when no
// state lies there.
void CutLog(const CutSource& source, double t0, double t1, const std::string& file);

// Writes the same window as the table that hydro-log export writes. With `si`, the table is in SI units, and
// its column names say so.
void CutTable(const CutSource& source, double t0, double t1, bool si, const std::string& log_file,
              const std::string& table_file);

}  // namespace hydro::scope
