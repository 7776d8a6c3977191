// A TOML document as a flat list, and changes of values in its text that leave everything else as it is:
// comments, order, blank lines.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "settings/toml/toml_document.h"

namespace hydro::settings {

// A TOML document as a flat list.
using TomlEntry = std::pair<std::string, std::string>;  // "section.key", and its value as TOML on one line

// All entries of a table and of the tables in it, in the order of their keys. Equal values have equal text,
// no matter how they were written.
std::vector<TomlEntry> TomlEntries(const TomlNode& table);

// Returns `text` without `removed` and with each of `changed` ("section.key", its value as TOML) in place of
// its old value, or new at the end of its section. Comments after a value stay, unless `comments` has another
// one for its key. Throws InputError when the document is written in a way that hides its values from this
// function (an inline table, a dotted key), because no text is better than a wrong one.
std::string EditToml(const std::string& text, const std::string& name, const std::vector<TomlEntry>& changed,
                     const std::vector<std::string>& removed,
                     const std::map<std::string, std::string>& comments = {});

}  // namespace hydro::settings
