// A window of a run as a file.
#pragma once

#include <optional>
#include <string>

#include "scope/signals/run.h"

namespace hydro::scope {

// What is needed of a run to cut a window out of it on another thread.
struct CutSource {
  std::optional<MessageStore::Snapshot> messages;  // of a live run; else the log
  std::string log_file;
  std::string name;
  std::string suffix;
  int64_t session = 0;
};

CutSource CutSourceOf(const Run& run);

// Writes the messages of [t0, t1] (s of plant time) as a log, with its description. Throws InputError when no state lies
// there.
void CutLog(const CutSource& source, double t0, double t1, const std::string& file);

// The same as the table that hydro-log export writes; `si`: in SI units, with their names in the columns.
void CutTable(const CutSource& source, double t0, double t1, bool si, const std::string& log_file,
              const std::string& table_file);

}  // namespace hydro::scope
