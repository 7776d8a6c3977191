// The layout of a CSV text, found by the names of the columns that are asked for.
#pragma once

#include <optional>
#include <string>

#include "base/tables/csv_layout.h"
#include "base/tables/csv_lines.h"

namespace hydro::tables {

// The line that has most of the names tells what separates cells; between it and the first row may be a line of
// units, and others that are passed over. Other columns may hold anything. Empty where no line has any of the names.
// Throws InputError where two separators fit as well, and where only some of the asked columns have units.
std::optional<CsvLayout> FindAskedLayout(const Lines& lines, const std::string& file,
                                         const CsvSettings& settings, const AskedColumns& asked);

}  // namespace hydro::tables
