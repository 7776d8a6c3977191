// Collects the numbers that a case leaves in its files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "batch/study/study.h"

namespace hydro::batch {

// The numbers in the order of study.collect; none where the file says null. The file exit_codes.json is the
// list of `exit_codes`, the exit codes of the steps. Throws InputError naming file and pointer.
std::vector<std::optional<Value>> CollectNumbers(const Study& study, const std::string& folder,
                                                 const std::vector<int>& exit_codes);

}  // namespace hydro::batch
