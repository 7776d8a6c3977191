// Adjusts the paths in a configuration that is saved in another folder.
#pragma once

#include <string>
#include <vector>

#include "settings/stack_config.h"
#include "settings/toml/toml_entries.h"

namespace hydro::settings {

// The keys of `config` with a relative path (model.file, bus.key_file, reference.file), with the values that
// they need in a file `output` to lead to the same files. Paths that stay the same are left out.
std::vector<TomlEntry> MovedPaths(const StackConfig& config, const std::string& output);

}  // namespace hydro::settings
