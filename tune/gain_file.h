// A configuration's text with other values of some keys: everything else stays as its author wrote it, comments too.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace hydro::tune {

// `text` with each "section.key" at its value (in TOML, on one line). A key that is not there comes at the end of its section,
// a section that is not there at the end of the text. For keys that stand on a line of their own under [section];
// the caller checks what the result means.
std::string WithKeys(const std::string& text, const std::vector<std::pair<std::string, std::string>>& keys);

}  // namespace hydro::tune
