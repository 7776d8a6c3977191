// Converts JSON to text. It is compiled once: nlohmann's writer costs seconds in each file that uses it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hydro {

// The text is always UTF-8, and no exception is thrown: bytes of strings that are not UTF-8 become U+FFFD,
// numbers that are not finite become null. `indent` is the number of blanks for each level; -1: all on one
// line. Every JSON text that a program writes comes from here; a test checks that.
std::string JsonText(const nlohmann::json& value, int indent = -1);
std::string JsonText(const nlohmann::ordered_json& value, int indent = -1);

}  // namespace hydro
