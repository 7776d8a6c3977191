#include "base/word_list.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <sstream>

#include "base/text_file.h"

namespace hydro {

std::vector<std::string> TextLines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(std::move(line));
  return lines;
}

std::string Trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string ShellWord(const std::string& text) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

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

std::string RunsNamed(const std::vector<std::string>& names, size_t runs) {
  return names.size() == runs && runs > 1 ? "every run" : RunsNamed(names);
}

namespace {

// Levenshtein distance, ignoring case.
size_t Edits(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const bool same = std::tolower(static_cast<unsigned char>(a[i - 1])) ==
                        std::tolower(static_cast<unsigned char>(b[j - 1]));
      const size_t replaced = diagonal + (same ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string Nearest(const std::string& found, const std::vector<std::string>& names) {
  if (found.empty() || found.size() > 64) return "";
  std::string nearest;
  size_t fewest = found.size() <= 3 ? 1 : 1 + found.size() / 4;  // more edits make another word
  for (const std::string& name : names) {
    // A key without its unit, or only its first part ("frequency" for "frequency_hz"), also counts as near.
    const bool beginning =
        found.size() >= 4 && name.size() > found.size() && name.compare(0, found.size(), found) == 0;
    const size_t edits = beginning ? 1 : Edits(found, name);
    if (edits <= fewest && (nearest.empty() || edits < fewest)) {
      fewest = edits;
      nearest = name;
    }
  }
  return nearest;
}

std::string DidYouMean(const std::string& found, const std::vector<std::string>& names) {
  const std::string nearest = Nearest(found, names);
  return nearest.empty() ? "" : ", did you mean " + Quoted(nearest) + "?";
}

}  // namespace hydro
