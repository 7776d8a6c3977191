// A whole log as runs.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "runs/recorded/run_log.h"
#include "scope/signals/run.h"

namespace hydro::scope {

// Opens one run for each plant session in the log, in the log's order, at least one; their ids are 0. For a
// limb, there is one for each joint, unless `choice` names one. For a damaged log, the runs hold what
// precedes the damage, which `problem` then names. All of it is kept in memory: some 150 bytes per tick.
// Throws InputError when the file is not a log, or holds no state.
std::vector<std::unique_ptr<Run>> OpenLogRuns(const std::string& file, const std::string& name,
                                              std::string* problem, const runs::StackChoice& choice = {});

}  // namespace hydro::scope
