// How long the cases of a study took, according to its folder.
#pragma once

#include <optional>
#include <string>

namespace hydro::batch {

// The mean time in s of the cases listed in times/ (run/case_times.h), in the 100 files that were written
// last. None when no case is listed.
std::optional<double> MeanCaseSeconds(const std::string& folder);

}  // namespace hydro::batch
