// Which of day, month and year comes first in a table's dates, where their places do not tell it.
#pragma once

#include "base/tables/clock_text.h"
#include "base/tables/csv_layout.h"
#include "base/tables/csv_text.h"

namespace hydro::tables {

// Goes through the rows of a text, which stands before its first row, and finds the order of the dates in the
// asked column of times or dates: the only one in which all of them are dates. Where all rows have the same
// date, its order does not matter. Throws InputError, with the sidecar's line that settles it, where the
// dates can be read in two ways, and where they contradict each other. kUnknown: these are no such dates.
DateOrder FindDateOrder(CsvText rows, const AskedColumns& asked);

}  // namespace hydro::tables
