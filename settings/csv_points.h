// The points of a trajectory from a CSV table.
#pragma once

#include <string>
#include <vector>

#include "base/input_error.h"
#include "model/trajectory/trajectory.h"

namespace hydro::settings {

// Reads the columns time_s and `column` of a CSV file (csv_text.h). The cells may also be separated by
// semicolons or tabs, with decimal commas; other columns may hold anything. Throws InputError "FILE: line N,
// column NAME: ..." for cells that are not finite numbers, for rows whose length differs from that of the
// names, and for times that do not increase.
std::vector<trajectory::Step> ReadCsvPoints(const std::string& file, const std::string& column);

// The same, from the file's text.
std::vector<trajectory::Step> ParseCsvPoints(const std::string& text, const std::string& file,
                                             const std::string& column);

}  // namespace hydro::settings
