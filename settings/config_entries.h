// Entries of a configuration: what the processes of a stack must agree on, and the paths that change when
// it is saved in another folder.
#pragma once

#include <string>
#include <vector>

#include "settings/stack_config.h"
#include "settings/toml/toml_edit.h"

namespace hydro::settings {

// One line "key = value", sorted by key, for each entry of the configuration and of its model on which more
// than one process acts, and for the version of this program. Two processes may run together when their texts
// are equal. The text leaves out what one process alone acts on (noise, driver, the length of the run) and
// what may differ by host (paths, bus, processors).
std::string AgreedEntries(const StackConfig& config);

// The keys of `config` with a relative path (model.file, bus.key_file, reference.file), with the values that
// they need in a file `output` to lead to the same files. Paths that stay the same are left out.
std::vector<TomlEntry> MovedPaths(const StackConfig& config, const std::string& output);

}  // namespace hydro::settings
