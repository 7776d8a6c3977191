// hydro-launch CONFIG --make-key.
#pragma once

#include "settings/command_line.h"

namespace hydro::launch {

// Writes a new key into the file that the configuration's bus.key_file names, and says so on stdout. Returns
// the exit code. Throws InputError when there is no such key or the file is there already.
int MakeKey(const settings::CommonOptions& options);

}  // namespace hydro::launch
