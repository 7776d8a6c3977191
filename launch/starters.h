// What hydro-launch makes for a start: a key (--make-key), and files from the examples (new-controller,
// new-driver).
#pragma once

#include <string>

#include "settings/command_line.h"

namespace hydro::launch {

// Writes a new key into the file that the configuration's bus.key_file names, and confirms it on stdout.
// Returns the exit code. Throws InputError when the configuration has no bus.key_file or the file exists
// already.
int MakeKey(const settings::CommonOptions& options);

// Writes NAME.py, a first position loop, and NAME.toml, a stack that uses it, into the current folder, and
// prints what to do with them. Returns the exit code. Throws InputError for a name that cannot be used, and
// when one of the two files exists already.
int NewController(const std::string& name);

// Makes a folder NAME with a first driver, NAME.cc, a simulated device, a stack with both, NAME.toml, and
// what CMake needs, and prints what to do with them. Returns the exit code. Throws InputError for a name that
// cannot be used, and when such a folder exists already.
int NewDriver(const std::string& name);

}  // namespace hydro::launch
