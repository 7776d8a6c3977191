// The stacks that are tortured.
#pragma once

#include <string>

#include "settings/stack_config.h"
#include "sim/torture/schedule/schedule.h"

namespace hydro::torture {

// The configuration of a schedule's stack: the shipped one, or `file` (empty: none), with the schedule's
// modes.
settings::StackConfig ConfigFor(const Schedule& schedule, const std::string& file);

// The same stack with other gains and limits: what a process that was restarted by mistake runs.
settings::StackConfig OtherConfig(const settings::StackConfig& config);

// The same stack as one joint of a limb, beside the other; and what such joints have in common, for an operator.
settings::StackConfig HipOf(settings::StackConfig config);
settings::StackConfig KneeOf(settings::StackConfig config);
settings::StackConfig LimbOf(settings::StackConfig config);

// The same configuration, of a program of another version.
settings::StackConfig OtherVersion(settings::StackConfig config);

}  // namespace hydro::torture
