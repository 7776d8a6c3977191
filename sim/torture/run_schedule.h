// One run of one schedule.
#pragma once

#include <string>

#include "sim/torture/schedule/schedule.h"
#include "sim/torture/world.h"

namespace hydro::torture {

// `config_file`: a stack of one's own; empty: the shipped one. `tail`: is told what happens; null: nobody is.
RunOutcome RunSchedule(const Schedule& schedule, const std::string& config_file, MessageTail* tail = nullptr);

}  // namespace hydro::torture
