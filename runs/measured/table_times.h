// Corrects the times of a table before a run uses them, where it is certain how they should increase.
#pragma once

#include <string>

#include "base/input_error.h"
#include "base/tables/table.h"
#include "runs/measured/signal_columns.h"

namespace hydro::runs {

// Corrects the table where it shows what its recorder is known to have done, and notes this in its layout:
// - rows that repeat the row before, including its time, are left out;
// - a counter of 16, 24 or 32 bits that rolls over is unwrapped, as is a time of day across midnight, and a
//   clock without a time zone that was set by an hour.
// `source.column` is the time, and lies in the table. Throws InputError for times that still do not increase,
// with the number of such rows and a remedy, and for times of arrival, where many rows come at once, again
// and again.
void MendTimes(const SignalColumn& source, tables::Table* table);

}  // namespace hydro::runs
