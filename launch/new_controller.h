// hydro-launch new-controller NAME.
#pragma once

#include <string>

namespace hydro::launch {

// Writes NAME.py, a position loop to begin with, and NAME.toml, a stack with it, into the current folder, and says what to do
// with them. Returns the exit code. Throws InputError for a name that is none, and when one of the two is there already.
int NewController(const std::string& name);

}  // namespace hydro::launch
