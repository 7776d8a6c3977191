// Which process of a limb runs which joint.
#pragma once

#include <string>
#include <vector>

#include "settings/stack_config.h"

namespace hydro::settings {

// The joints that a process of a limb runs, in the order of the configuration.
std::vector<std::string> JointsOf(const ProcessSection& process, const StackConfig& common);

// Checks that one process, or one stack of processes, runs each joint. Throws InputError naming the place of
// a section.
void CheckProcesses(const StackConfig& common);

// Checks that one process simulates everything that couples the joints. Throws InputError.
void CheckArmIsWhole(const StackConfig& common);

}  // namespace hydro::settings
