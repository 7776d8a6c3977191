#include "settings/toml/section_lists.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace hydro::settings {
namespace {

// The sections of this project's documents that are lists.
constexpr std::array kLists{"joint", "process", "arm.link"};

// A line without blanks and comments.
std::string Bare(std::string_view line) {
  std::string bare(line.substr(0, line.find('#')));
  std::erase_if(bare, [](unsigned char c) { return std::isspace(c); });
  return bare;
}

}  // namespace

InputError NotAList(const std::string& place, const std::string& name) {
  return InputError(place + ": " + name + ": found a section [" + name +
                    "], allowed a list of sections: write [[" + name + "]]");
}

void RefuseSingleBrackets(std::string_view text, const std::string& name, size_t at) {
  std::vector<std::string> lines;
  for (size_t begin = 0; begin < text.size() && lines.size() < at;) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(Bare(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  for (const std::string list : kLists) {
    const std::string single = "[" + list + "]";
    if (lines.empty() || (lines.back() != single && lines.back() != "[" + single + "]")) continue;
    const auto first = std::find(lines.begin(), lines.end(), single);
    if (first != lines.end()) throw NotAList(name + ":" + std::to_string(first - lines.begin() + 1), list);
  }
}

}  // namespace hydro::settings
