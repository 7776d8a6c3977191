// What a TOML text defines twice: toml++ reports it in words of its own, and garbles quoted names.
#pragma once

#include <string>
#include <string_view>

namespace hydro::settings {

// When the parser reports a table defined twice, at line `at` of a text, that table may be a list whose
// sections have single brackets. If it is, throws InputError for the first of them.
void RefuseSingleBrackets(std::string_view text, const std::string& name, size_t at);

// Throws InputError for the section or the key at line `at` that an earlier line has, and names that line
// where it is found.
[[noreturn]] void RefuseSecondDefinition(std::string_view text, const std::string& name, size_t at);

}  // namespace hydro::settings
