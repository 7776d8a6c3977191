// Which part of a log is exported.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runs/exports/sheet.h"
#include "runs/run_log.h"

namespace hydro::exports {

// The name by which the run's table is chosen among channels.
inline constexpr const char* kTableName = "table";

struct Selection {
  std::vector<std::string>
      channels;                  // by name, with or without the suffix, or kTableName; empty: the table alone
  bool all = false;              // the table, where the log has one, and all channels of the stack
  std::optional<double> from_s;  // plant time
  std::optional<double> to_s;
  double rate_hz = 0;  // 0: every row
  bool si = false;
};

// Throws InputError for a window that ends before it begins, numbers that are none and a rate below 0.
void CheckSelection(const Selection& selection);

// The chosen channels without suffix, each once, in the order of bus/messages.h, those that hold a message of the log. Throws InputError
// for a name that is none of the stack's channels or of which the log holds no message.
std::vector<std::string> ChosenChannels(const Selection& selection, const runs::RunLog& log);

// Whether the run's table is wanted.
bool WantsTable(const Selection& selection);

// Leaves the rows of the window, and of sheets with a row for every tick or sample the first in each interval of 1/rate_hz.
void Cut(const Selection& selection, Sheet* sheet);

}  // namespace hydro::exports
