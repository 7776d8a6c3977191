// One run of one schedule.
#pragma once

#include <string>

#include "torture/schedule/schedule.h"
#include "torture/world.h"

namespace hydro::torture {

// `config_file`: a stack of one's own; empty: the shipped one.
RunOutcome RunSchedule(const Schedule& schedule, const std::string& config_file);

}  // namespace hydro::torture
