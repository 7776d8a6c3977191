// A TOML document as a flat list.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "settings/toml/toml_document.h"

namespace hydro::settings {

using TomlEntry = std::pair<std::string, std::string>;  // "section.key", and its value as TOML on one line

// All entries of a table and of the tables in it, in the order of their keys. Equal values have equal text,
// no matter how they were written.
std::vector<TomlEntry> TomlEntries(const TomlNode& table);

}  // namespace hydro::settings
