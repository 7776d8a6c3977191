// Finds the layout of a CSV text from the names of the columns that are asked for.
#pragma once

#include <optional>
#include <string>

#include "base/tables/csv_cells.h"
#include "base/tables/csv_layout.h"

namespace hydro::tables {

// The line that has most of the names determines the separator of cells. Between it and the first row there
// may be a line of units, and others that are skipped. Other columns may hold anything. Empty when no line
// has any of the names. Throws InputError when two separators fit equally well, and when only some of the
// asked columns have units.
std::optional<CsvLayout> FindAskedLayout(const Lines& lines, const std::string& file,
                                         const CsvSettings& settings, const AskedColumns& asked);

}  // namespace hydro::tables
