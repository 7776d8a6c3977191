// What the rows of a CSV text decide: its decimal sign, and whether day or month comes first in its dates.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/input_error.h"
#include "base/tables/clock_text.h"
#include "base/tables/csv_layout.h"
#include "base/tables/csv_text.h"

namespace hydro::tables {

// '.' or ',', from the asked cells of all rows from line `first` on. Throws InputError, which states what to
// set, when commas may also mark thousands, and when both signs occur.
char FindDecimal(std::string_view text, const std::string& file, const CsvLayout& layout, size_t first,
                 const AskedColumns& asked = {});

// Goes through the rows of a text, which stands before its first row, and finds the order of the dates in the
// asked column of times or dates: that in which a number above 12 is a day. Where all rows have the same
// date, its order does not matter. Throws InputError, with the sidecar's line that settles it, where the
// dates can be read in two ways, and where they contradict each other. kUnknown: these are no dates with
// slashes.
DateOrder FindDateOrder(CsvText rows, const AskedColumns& asked);

}  // namespace hydro::tables
