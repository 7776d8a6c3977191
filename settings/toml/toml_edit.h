// Changes values in the text of a TOML document and leaves everything else as it is: comments, order, blank
// lines.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "settings/toml/toml_entries.h"

namespace hydro::settings {

// Returns `text` without `removed` and with each of `changed` ("section.key", its value as TOML) in place of
// its old value, or new at the end of its section. Comments after a value stay, unless `comments` has another
// one for its key. Throws InputError when the document is written in a way that hides its values from this
// function (an inline table, a dotted key), because no text is better than a wrong one.
std::string EditToml(const std::string& text, const std::string& name, const std::vector<TomlEntry>& changed,
                     const std::vector<std::string>& removed,
                     const std::map<std::string, std::string>& comments = {});

}  // namespace hydro::settings
