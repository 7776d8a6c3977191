// The sign of decimals in a CSV text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/input_error.h"

namespace hydro::tables {

// '.' or ',', from all rows from line `first` on. Throws InputError, which says what to set, where commas may
// as well mark thousands, and where there are both signs.
char FindDecimal(std::string_view text, const std::string& file, char separator, size_t first);

}  // namespace hydro::tables
