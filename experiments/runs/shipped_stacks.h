// The stack configurations of config/, compiled in, so that an experiment needs no path.
#pragma once

#include <string>
#include <vector>

namespace hydro::experiments {

// The text of config/NAME.toml with each "section.key=value" of `overrides` applied as --set does. Throws
// std::out_of_range for an unknown name, InputError for a faulty override.
std::string ShippedStackText(const std::string& name, const std::vector<std::string>& overrides = {});

}  // namespace hydro::experiments
