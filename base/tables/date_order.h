// Which of day and month comes first in a table's dates with slashes.
#pragma once

#include "base/tables/clock_text.h"
#include "base/tables/csv_layout.h"
#include "base/tables/csv_text.h"

namespace hydro::tables {

// Goes through the rows of a text, which stands before its first row, and finds the order of the dates in the
// asked column of times or dates: that in which a number above 12 is a day. Where all rows have the same
// date, its order does not matter. Throws InputError, with the sidecar's line that settles it, where the
// dates can be read in two ways, and where they contradict each other. kUnknown: these are no dates with
// slashes.
DateOrder FindDateOrder(CsvText rows, const AskedColumns& asked);

}  // namespace hydro::tables
