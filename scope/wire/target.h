// The target of a request: its path and query.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hydro::scope {

struct Target {
  std::string path;
  std::map<std::string, std::string> query;  // the first value of each name
};

// Empty when the text is not a path, or when it has a wrong escape or a zero byte.
std::optional<Target> ParseTarget(std::string_view target);

// Splits "a, b" into its parts.
std::vector<std::string> ListOf(std::string_view header);

}  // namespace hydro::scope
