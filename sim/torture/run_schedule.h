// Runs one schedule once.
#pragma once

#include <string>

#include "sim/torture/schedule/schedule.h"
#include "sim/torture/world.h"

namespace hydro::torture {

// `config_file` is a stack of the user's own; empty: the shipped one. `tail` is told what happens; it may be
// null.
RunOutcome RunSchedule(const Schedule& schedule, const std::string& config_file, MessageTail* tail = nullptr);

}  // namespace hydro::torture
