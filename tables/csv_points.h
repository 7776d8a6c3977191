// The points of a trajectory from a CSV table.
#pragma once

#include <string>
#include <vector>

#include "base/input_error.h"
#include "trajectory/trajectory.h"

namespace hydro::tables {

// Reads the columns time_s and `column`: one header row with the names, then rows of numbers, separated by
// commas. Blank lines and lines that begin with # are skipped. Throws InputError "file:row:column: ..." for
// what is not a finite number, for rows of another length than the header's and for times that do not
// increase.
std::vector<trajectory::Step> ReadCsvPoints(const std::string& file, const std::string& column);

// The same from the file's text.
std::vector<trajectory::Step> ParseCsvPoints(const std::string& text, const std::string& file,
                                             const std::string& column);

}  // namespace hydro::tables
