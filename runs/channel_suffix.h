// Which stack's channels of a log are read, where it holds several.
#pragma once

#include <optional>
#include <set>
#include <string>

#include "runs/run_log.h"

namespace hydro::runs {

// The suffixes of the state channels that a log holds.
std::set<std::string> StateSuffixes(const RunLog& log);

// The suffix to read, by the rule of ReadRunLog(). `log` has its list of channels. Throws InputError.
std::string ChooseSuffix(const RunLog& log, const std::optional<std::string>& wanted);

}  // namespace hydro::runs
