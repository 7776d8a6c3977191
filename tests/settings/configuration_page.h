// docs/configuration.md: its tables' columns `default`, `allowed`, and `kind` or `source`, written from the
// code.
#pragma once

#include <string>
#include <vector>

#include "tests/settings/configuration_facts.h"

namespace hydro::settings {

// `page` with these columns brought up to date. A table of keys has a first column `key` and belongs to the
// section that stands in a heading "## `[section]`" or begins a line "`[section]`" before it; its other
// columns, the order of its rows, and the defaults of HandWrittenDefaults() stay as they are. Throws
// InputError naming `name` (the file) and the line for a row with a key that the code does not know, a second
// row of a key, and a default by hand that is empty or no longer needed; and for keys without a row.
std::string CurrentConfigurationPage(const std::string& page, const std::string& name,
                                     const std::vector<KeyFacts>& facts);

}  // namespace hydro::settings
