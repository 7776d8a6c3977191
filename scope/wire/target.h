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
  std::map<std::string, std::string> query;  // the first of each name
};

// Empty when it is no path, or an escape or a zero byte in it is wrong.
std::optional<Target> ParseTarget(std::string_view target);

// "a, b" as its parts.
std::vector<std::string> ListOf(std::string_view header);

}  // namespace hydro::scope
