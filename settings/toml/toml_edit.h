// Changes values in the text of a TOML document and leaves all else as it is: comments, order, blank lines.
#pragma once

#include <string>
#include <vector>

#include "settings/toml/toml_entries.h"

namespace hydro::settings {

// `text` with each of `changed` ("section.key", its value as TOML) in the place of its old value, or new at the end of its section,
// and without `removed`. Comments behind a value stay. Throws InputError when the document is written in a way in which this does not find
// its values (an inline table, a dotted key): no text is better than a wrong one.
std::string EditToml(const std::string& text, const std::string& name, const std::vector<TomlEntry>& changed,
                     const std::vector<std::string>& removed);

}  // namespace hydro::settings
