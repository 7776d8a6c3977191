// The files that a configuration names, when it is saved in another folder.
#pragma once

#include <string>
#include <vector>

#include "settings/stack_config.h"
#include "settings/toml/toml_entries.h"

namespace hydro::settings {

// The keys of `config` with a relative path (model.file, bus.key_file, reference.file), as they must be in a file `output` to lead to the
// same files; those that stay as they are are left out.
std::vector<TomlEntry> MovedPaths(const StackConfig& config, const std::string& output);

}  // namespace hydro::settings
