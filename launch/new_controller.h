// Implements hydro-launch new-controller NAME.
#pragma once

#include <string>

namespace hydro::launch {

// Writes NAME.py, a first position loop, and NAME.toml, a stack that uses it, into the current folder, and
// prints what to do with them. Returns the exit code. Throws InputError for a name that cannot be used, and
// when one of the two files exists already.
int NewController(const std::string& name);

}  // namespace hydro::launch
