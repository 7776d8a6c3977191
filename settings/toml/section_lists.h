// Finds lists of sections, [[name]], that are written as [name].
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/input_error.h"

namespace hydro::settings {

// The error for the section `name` of a list of sections that is written as [name].
InputError NotAList(const std::string& place, const std::string& name);

// When the parser reports a table defined twice, at line `at` of a text, that table may be a list whose
// sections have single brackets. If it is, throws InputError for the first of them.
void RefuseSingleBrackets(std::string_view text, const std::string& name, size_t at);

}  // namespace hydro::settings
