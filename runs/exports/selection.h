// The part of a log that is exported.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runs/exports/sheet.h"
#include "runs/recorded/run_log.h"

namespace hydro::exports {

// The name that chooses the run's table among channels.
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

// Throws InputError for a window that ends before it begins, for values that are not numbers and for a rate
// below 0.
void CheckSelection(const Selection& selection);

// The chosen channels without suffix, each once, in the order of bus/messages.h, as far as the log holds a
// message on them. Throws InputError for a name that is not one of the stack's channels, or for which the log
// holds no message.
std::vector<std::string> ChosenChannels(const Selection& selection, const runs::RunLog& log);

// Whether the run's table is wanted.
bool WantsTable(const Selection& selection);

// Keeps the rows within the window. In sheets with a row for every tick or sample, keeps only the first row
// in each interval of 1/rate_hz.
void Cut(const Selection& selection, Sheet* sheet);

}  // namespace hydro::exports
