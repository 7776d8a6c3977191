#include "settings/toml/defined_twice.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <vector>

#include "base/input_error.h"
#include "settings/toml/section_reader.h"

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

// The lines up to line `at`, bare.
std::vector<std::string> BareLines(std::string_view text, size_t at) {
  std::vector<std::string> lines;
  for (size_t begin = 0; begin < text.size() && lines.size() < at;) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(Bare(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return lines;
}

// The key in front of the = of a bare line; "" where there is none.
std::string KeyOf(const std::string& line) {
  const size_t end = line.find('=');
  return end == std::string::npos ? "" : line.substr(0, end);
}

// The place of the line that has the section or the key of the last one. A key is one of its own section.
std::optional<size_t> FirstDefinition(const std::vector<std::string>& lines, bool section) {
  for (size_t i = lines.size() - 1; i-- > 0;) {
    if (section ? lines[i] == lines.back() : KeyOf(lines[i]) == KeyOf(lines.back())) return i;
    if (!section && lines[i].starts_with("[")) break;
  }
  return std::nullopt;
}

}  // namespace

void RefuseSingleBrackets(std::string_view text, const std::string& name, size_t at) {
  const std::vector<std::string> lines = BareLines(text, at);
  for (const std::string list : kLists) {
    const std::string single = "[" + list + "]";
    if (lines.empty() || (lines.back() != single && lines.back() != "[" + single + "]")) continue;
    const auto first = std::find(lines.begin(), lines.end(), single);
    if (first != lines.end()) throw NotAList(name + ":" + std::to_string(first - lines.begin() + 1), list);
  }
}

void RefuseSecondDefinition(std::string_view text, const std::string& name, size_t at) {
  const std::vector<std::string> lines = BareLines(text, at);
  const std::string place = name + ":" + std::to_string(at) + ": syntax: found ";
  const std::string last = lines.empty() ? "" : lines.back();
  const bool section = last.starts_with("[");
  const std::string what = section ? last : KeyOf(last);
  const std::optional<size_t> first = what.empty() ? std::nullopt : FirstDefinition(lines, section);
  if (!first.has_value()) {
    throw InputError(place + "what the file has already, allowed each key and each section once");
  }
  throw InputError(
      place + what + " again, which line " + std::to_string(*first + 1) + " has, allowed each " +
      (section ? "section once: write the keys of both in one" : "key once: leave one of the two out"));
}

}  // namespace hydro::settings
