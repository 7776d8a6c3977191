// Checks a study's values before anything runs.
#pragma once

#include <string>

#include "batch/study/study.h"
#include "settings/toml/toml_document.h"

namespace hydro::batch {

// The place where a study's file names a varied key; `which` is 0 for the first such place. Without one,
// returns the place of its list, or of the whole file.
std::string PlaceOfKey(const settings::TomlNode& root, const std::string& key, size_t which = 0);

// Checks that every value of the grid, of the list's first rows and of the first draws gives a configuration
// that can run. Throws InputError naming the place in `root`, which was read from `file`, the key and its
// value.
void CheckConfigurations(const Study& study, const settings::TomlNode& root, const std::string& file);

}  // namespace hydro::batch
