// What is wrong with a study's values, before anything runs.
#pragma once

#include <string>

#include "batch/study/study.h"
#include "settings/toml/toml_document.h"

namespace hydro::batch {

// Where a study's file names a varied key; `which`: 0 where it does so first. Without such a place: that of its list, or of the whole.
std::string PlaceOfKey(const settings::TomlNode& root, const std::string& key, size_t which = 0);

// Every value of the grid, of the list's first rows and of the first draws gives a configuration that can run. Throws InputError naming the
// place in `root`, which was read from `file`, the key and its value.
void CheckConfigurations(const Study& study, const settings::TomlNode& root, const std::string& file);

}  // namespace hydro::batch
