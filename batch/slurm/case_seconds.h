// How long the cases of a study took, from its folder.
#pragma once

#include <optional>
#include <string>

namespace hydro::batch {

// s; the mean of the cases that times/ tells of (run/case_times.h), of the 100 files written last. None when it tells of none.
std::optional<double> MeanCaseSeconds(const std::string& folder);

}  // namespace hydro::batch
