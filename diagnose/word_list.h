// Several words in one text.
#pragma once

#include <string>
#include <vector>

namespace hydro {

// "a, b, c"
std::string Joined(const std::vector<std::string>& parts, const std::string& between = ", ");
// "a, b and c"
std::string Enumerated(const std::vector<std::string>& parts);

}  // namespace hydro
