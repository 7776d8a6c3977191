#include "tune/gain_file.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <sstream>

namespace hydro::tune {
namespace {

constexpr const char* kBlank = " \t\r";

std::string Trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(kBlank);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

// The section that a line opens: "position" for "[position]  # eq. (17)"; empty for any other line.
std::string SectionOf(const std::string& line) {
  const std::string text = Trimmed(line);
  if (text.empty() || text[0] != '[') return "";
  const size_t end = text.find(']');
  return end == std::string::npos ? "" : Trimmed(text.substr(1, end - 1));
}

// What stands before the equals sign.
std::string KeyOf(const std::string& line) {
  const size_t equals = line.find('=');
  return equals == std::string::npos ? "" : Trimmed(line.substr(0, equals));
}

// Where a comment begins, outside of strings; the line's length when it has none.
size_t CommentOf(const std::string& line) {
  char quote = 0;
  for (size_t i = 0; i < line.size(); ++i) {
    if (quote != 0) {
      if (line[i] == '\\' && quote == '"')
        ++i;
      else if (line[i] == quote)
        quote = 0;
    } else if (line[i] == '"' || line[i] == '\'') {
      quote = line[i];
    } else if (line[i] == '#') {
      return i;
    }
  }
  return line.size();
}

// The comment stays in its column where the value leaves room.
std::string WithValue(const std::string& line, const std::string& value) {
  const size_t comment = CommentOf(line);
  std::string changed = line.substr(0, line.find('=') + 1) + " " + value;
  if (comment == line.size()) return changed;
  changed.resize(std::max(changed.size() + 1, comment), ' ');
  return changed + line.substr(comment);
}

class Lines {
 public:
  explicit Lines(const std::string& text) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines_.push_back(line);
  }

  void Set(const std::string& section, const std::string& key, const std::string& value) {
    std::string open;
    auto end = lines_.end();  // after the section's last key
    for (auto line = lines_.begin(); line != lines_.end(); ++line) {
      const std::string header = SectionOf(*line);
      if (!header.empty()) open = header;
      if (open != section) continue;
      if (header.empty() && KeyOf(*line) == key) {
        *line = WithValue(*line, value);
        return;
      }
      if (!header.empty() || !KeyOf(*line).empty()) end = std::next(line);
    }
    if (end == lines_.end() && open != section) {
      lines_.emplace_back();
      lines_.push_back("[" + section + "]");
      end = lines_.end();
    }
    lines_.insert(end, key + " = " + value);
  }

  std::string Text() const {
    std::string text;
    for (const std::string& line : lines_) text += line + "\n";
    return text;
  }

 private:
  std::vector<std::string> lines_;
};

}  // namespace

std::string WithKeys(const std::string& text, const std::vector<std::pair<std::string, std::string>>& keys) {
  Lines lines(text);
  for (const auto& [name, value] : keys) {
    const size_t dot = name.rfind('.');
    lines.Set(name.substr(0, dot), name.substr(dot + 1), value);
  }
  return lines.Text();
}

}  // namespace hydro::tune
