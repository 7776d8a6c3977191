// JSON to text, compiled once: nlohmann's writer costs seconds in each file that uses it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hydro {

// Always UTF-8, never an exception: bytes of strings that are no UTF-8 become U+FFFD, numbers that are not
// finite null. `indent`: blanks for each level; -1: all on one line. Every JSON that a program writes comes
// from here; a test says so.
std::string JsonText(const nlohmann::json& value, int indent = -1);
std::string JsonText(const nlohmann::ordered_json& value, int indent = -1);

}  // namespace hydro
