// The times of a table, made to increase where it is certain how, before they are a run's.
#pragma once

#include <string>

#include "base/input_error.h"
#include "base/tables/table.h"
#include "runs/signal_columns.h"

namespace hydro::runs {

// Changes the table where its recorder is known to have done what it shows, and says so in its layout:
// - rows that repeat the one before, time and all, are left out;
// - a counter of 16, 24 or 32 bits that rolls over is counted on, as is a time of day over midnight, and a clock
//   without a zone that was set by an hour.
// `source.column` is the time, in the table. Throws InputError for times that do not increase after that, with how many rows
// are like that and what helps; and for times of arrival: many rows at once, again and again.
void MendTimes(const SignalColumn& source, tables::Table* table);

}  // namespace hydro::runs
