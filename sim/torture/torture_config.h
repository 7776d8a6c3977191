// The stacks that hydro-torture runs.
#pragma once

#include <string>

#include "settings/stack_config.h"
#include "sim/torture/schedule/schedule.h"

namespace hydro::torture {

// The configuration of a schedule's stack: the shipped one, or `file` (empty: none), with the schedule's
// modes.
settings::StackConfig ConfigFor(const Schedule& schedule, const std::string& file);

// The same stack with other gains and limits, as run by a process that was restarted by mistake.
settings::StackConfig OtherConfig(const settings::StackConfig& config);

// The same stack as one joint of a limb, then as the other joint; and what such joints have in common, for an
// operator.
settings::StackConfig HipOf(settings::StackConfig config);
settings::StackConfig KneeOf(settings::StackConfig config);
settings::StackConfig LimbOf(settings::StackConfig config);

// The same configuration for a program of another version.
settings::StackConfig OtherVersion(settings::StackConfig config);

}  // namespace hydro::torture
