// Finds the decimal sign of a CSV text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/input_error.h"
#include "base/tables/csv_layout.h"

namespace hydro::tables {

// '.' or ',', from the asked cells of all rows from line `first` on. Throws InputError, which states what to
// set, when commas may also mark thousands, and when both signs occur.
char FindDecimal(std::string_view text, const std::string& file, const CsvLayout& layout, size_t first,
                 const AskedColumns& asked = {});

}  // namespace hydro::tables
