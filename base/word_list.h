// Joins lists of words for a sentence.
#pragma once

#include <string>
#include <vector>

namespace hydro {

// "a, b, c"
std::string Joined(const std::vector<std::string>& parts, const std::string& between = ", ");
// "a, b and c"
std::string Enumerated(const std::vector<std::string>& parts);
// "run sine"; a name that already begins with "run" stays the same: "run 5"
std::string RunNamed(const std::string& name);
// "run a"; "runs a and b"; "run 5 and run 6"
std::string RunsNamed(const std::vector<std::string>& names);

}  // namespace hydro
