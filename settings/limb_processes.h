// Which process of a limb runs which joint.
#pragma once

#include <string>
#include <vector>

#include "settings/stack_config.h"

namespace hydro::settings {

// The joints that a process of a limb has, in the order of the configuration.
std::vector<std::string> JointsOf(const ProcessSection& process, const StackConfig& common);

// Each joint is run by one process, or by one stack of them. Throws InputError naming the place of a section.
void CheckProcesses(const StackConfig& common);

// What couples the joints is simulated in one process. Throws InputError.
void CheckArmIsWhole(const StackConfig& common);

}  // namespace hydro::settings
