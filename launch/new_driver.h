// hydro-launch new-driver NAME.
#pragma once

#include <string>

namespace hydro::launch {

// Makes a folder NAME with a driver to begin with, NAME.cc, a device that is simulated, a stack with both,
// NAME.toml, and what CMake needs, and says what to do with them. Returns the exit code. Throws InputError
// for a name that is none, and when there is such a folder already.
int NewDriver(const std::string& name);

}  // namespace hydro::launch
