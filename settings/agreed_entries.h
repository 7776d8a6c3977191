// What the processes of a stack must agree on.
#pragma once

#include <string>

#include "settings/stack_config.h"

namespace hydro::settings {

// One line "key = value", sorted by key, for each entry of the configuration and of its model on which more
// than one process acts, and for the version of this program. Two processes may run together when their texts
// are equal. The text leaves out what one process alone acts on (noise, driver, the length of the run) and
// what may differ by host (paths, bus, processors).
std::string AgreedEntries(const StackConfig& config);

}  // namespace hydro::settings
