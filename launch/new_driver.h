// Implements hydro-launch new-driver NAME.
#pragma once

#include <string>

namespace hydro::launch {

// Makes a folder NAME with a first driver, NAME.cc, a simulated device, a stack with both, NAME.toml, and
// what CMake needs, and prints what to do with them. Returns the exit code. Throws InputError for a name that
// cannot be used, and when such a folder exists already.
int NewDriver(const std::string& name);

}  // namespace hydro::launch
