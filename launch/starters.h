// Implements hydro-launch new-controller and new-driver: files made from the examples, as a start for the
// user.
#pragma once

#include <string>

namespace hydro::launch {

// Writes NAME.py, a first position loop, and NAME.toml, a stack that uses it, into the current folder, and
// prints what to do with them. Returns the exit code. Throws InputError for a name that cannot be used, and
// when one of the two files exists already.
int NewController(const std::string& name);

// Makes a folder NAME with a first driver, NAME.cc, a simulated device, a stack with both, NAME.toml, and
// what CMake needs, and prints what to do with them. Returns the exit code. Throws InputError for a name that
// cannot be used, and when such a folder exists already.
int NewDriver(const std::string& name);

}  // namespace hydro::launch
