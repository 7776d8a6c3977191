// Implements hydro-launch CONFIG --make-key.
#pragma once

#include "settings/command_line.h"

namespace hydro::launch {

// Writes a new key into the file that the configuration's bus.key_file names, and confirms it on stdout.
// Returns the exit code. Throws InputError when the configuration has no bus.key_file or the file exists
// already.
int MakeKey(const settings::CommonOptions& options);

}  // namespace hydro::launch
