// Lists of sections, [[name]], that stand as [name].
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/input_error.h"

namespace hydro::settings {

// For the section `name` of a list of sections, where it stands as [name].
InputError NotAList(const std::string& place, const std::string& name);

// What the parser calls a table defined twice, at line `at` of a text, may be a list whose sections have single brackets. Throws
// InputError then, for the first of them.
void RefuseSingleBrackets(std::string_view text, const std::string& name, size_t at);

}  // namespace hydro::settings
