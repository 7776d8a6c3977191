// Whether two studies are the same.
#pragma once

#include <string>

#include "batch/study/study.h"

namespace hydro::batch {

// The first difference, as "study.toml: grid[0].steps: was 5, is 6"; empty when there is none. What only
// affects the report does not count as a difference.
std::string StudyDifference(const Study& was, const Study& is);

}  // namespace hydro::batch
