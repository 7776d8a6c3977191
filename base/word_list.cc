#include "base/word_list.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace hydro {

std::string Joined(const std::vector<std::string>& parts, const std::string& between) {
  std::string joined;
  for (size_t i = 0; i < parts.size(); ++i) joined += (i == 0 ? "" : between) + parts[i];
  return joined;
}

std::string Enumerated(const std::vector<std::string>& parts) {
  if (parts.size() < 2) return Joined(parts);
  return Joined({parts.begin(), parts.end() - 1}) + " and " + parts.back();
}

std::string RunNamed(const std::string& name) {
  const bool says_it =
      name.starts_with("run") && name.size() > 3 && std::isalpha(static_cast<unsigned char>(name[3])) == 0;
  return says_it ? name : "run " + name;
}

std::string RunsNamed(const std::vector<std::string>& names) {
  const bool say_it =
      std::all_of(names.begin(), names.end(), [](const std::string& name) { return RunNamed(name) == name; });
  return names.size() == 1 ? RunNamed(names[0]) : (say_it ? "" : "runs ") + Enumerated(names);
}

}  // namespace hydro
