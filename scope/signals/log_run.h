// A whole log as runs.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runs/stack_choice.h"
#include "scope/signals/run.h"

namespace hydro::scope {

// One run for each plant session in the log, in its order, at least one; their ids are 0. Of a limb, one for each joint, unless `choice` names
// one. Of a damaged log, what precedes the
// damage, which `problem` then names. All of it is kept in memory: some 150 bytes a tick. Throws InputError when it is no log,
// or holds no state.
std::vector<std::unique_ptr<Run>> OpenLogRuns(const std::string& file, const std::string& name,
                                              std::string* problem, const runs::StackChoice& choice = {});

}  // namespace hydro::scope
