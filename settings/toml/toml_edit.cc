#include "settings/toml/toml_edit.h"

#include <algorithm>
#include <map>

#include "base/number_text.h"
#include "base/word_list.h"

namespace hydro::settings {
namespace {

using Kind = TomlNode::Kind;

std::vector<const TomlMember*> SortedMembers(const TomlNode& table) {
  std::vector<const TomlMember*> members;
  for (const TomlMember& member : table.members) members.push_back(&member);
  std::ranges::sort(members, {}, &TomlMember::first);
  return members;
}

// Writes a literal string, which needs no escapes, where possible.
std::string StringText(const std::string& text) {
  const bool literal =
      std::ranges::none_of(text, [](unsigned char c) { return c == '\'' || c < 0x20 || c == 0x7f; });
  return literal ? "'" + text + "'" : TomlString(text);
}

// A value as TOML on one line, with numbers in the shortest form that reads back the same.
std::string ValueText(const TomlNode& node) {
  std::string text;
  switch (node.kind) {
    case Kind::kTable:
      for (const TomlMember* member : SortedMembers(node)) {
        text += (text.empty() ? "" : ", ") + member->first + " = " + ValueText(member->second);
      }
      return "{" + text + "}";
    case Kind::kArray:
      for (const TomlNode& item : node.items) text += (text.empty() ? "" : ", ") + ValueText(item);
      return "[" + text + "]";
    case Kind::kString:
      return StringText(node.text);
    case Kind::kInteger:
      return std::to_string(node.integer);
    case Kind::kFloat:
      return NumberText(node.number);
    case Kind::kBoolean:
      return node.boolean ? "true" : "false";
    case Kind::kDate:
      return node.text;
  }
  return text;
}

void Flatten(const TomlNode& table, const std::string& prefix,
             std::vector<std::pair<std::string, std::string>>& entries) {
  for (const TomlMember* member : SortedMembers(table)) {
    const std::string name = prefix + member->first;
    if (member->second.is(Kind::kTable)) {
      Flatten(member->second, name + ".", entries);
    } else {
      entries.emplace_back(name, ValueText(member->second));
    }
  }
}

// Scans the text of a TOML value outside strings, for the start of a comment and the depth of the brackets.
struct ValueScan {
  int depth = 0;
  char quote = 0;

  // Returns where a comment begins in `line` at or after `from`, or the line's length where there is none.
  size_t Scan(const std::string& line, size_t from) {
    for (size_t i = from; i < line.size(); ++i) {
      const char c = line[i];
      if (quote != 0) {
        if (c == '\\' && quote == '"')
          ++i;
        else if (c == quote)
          quote = 0;
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '#') {
        return i;
      } else if (c == '[' || c == '{') {
        ++depth;
      } else if (c == ']' || c == '}') {
        --depth;
      }
    }
    return line.size();
  }
};

struct Place {
  size_t first = 0;    // line of the key
  size_t last = 0;     // line where its value ends
  size_t value = 0;    // column of the value in `first`
  size_t comment = 0;  // column after the value in `last`
};

struct Document {
  std::vector<std::string> lines;
  std::map<std::string, Place> keys;  // by dotted name, of tables that occur once
  std::map<std::string, size_t>
      section_ends;  // line after the last key of each section; "" is the document's head
};

Document Read(const std::string& text) {
  Document document;
  document.lines = TextLines(text);
  std::string section;
  bool in_array = false;  // [[...]]: several have the same name
  document.section_ends[""] = 0;
  for (size_t i = 0; i < document.lines.size(); ++i) {
    const std::string line = Trimmed(document.lines[i]);
    if (line.empty() || line.front() == '#') continue;
    if (line.front() == '[') {
      in_array = line.starts_with("[[");
      section = Trimmed(line.substr(1, line.find(']') - 1));
      if (!in_array) document.section_ends[section] = i + 1;
      continue;
    }
    const size_t equals = document.lines[i].find('=');
    if (equals == std::string::npos) continue;
    Place place{.first = i, .last = i};
    place.value = document.lines[i].find_first_not_of(" \t", equals + 1);
    if (place.value == std::string::npos) continue;
    ValueScan scan;
    place.comment = scan.Scan(document.lines[i], place.value);
    while (scan.depth > 0 && place.last + 1 < document.lines.size())
      place.comment = scan.Scan(document.lines[++place.last], 0);
    if (!in_array) {
      const std::string key = Trimmed(document.lines[i].substr(0, equals));
      document.keys[section.empty() ? key : section + "." + key] = place;
      document.section_ends[section] = place.last + 1;
    }
    i = place.last;
  }
  return document;
}

std::string Joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

// `comment` replaces the old one unless it is empty.
void Replace(Document* document, const Place& place, const std::string& value, const std::string& comment) {
  std::string behind = document->lines[place.last].substr(place.comment);
  if (!behind.empty()) {
    const std::string& old = document->lines[place.last];
    const size_t end = place.comment == 0 ? 0 : old.find_last_not_of(" \t", place.comment - 1) + 1;
    behind = old.substr(end, place.comment - end) + behind;
    // With a shorter value, the comment stays in its column.
    const size_t length = place.first == place.last ? end - place.value : 0;
    if (value.size() < length) behind.insert(0, length - value.size(), ' ');
  }
  if (!comment.empty())
    behind = (behind.empty() ? "  " : behind.substr(0, behind.find('#'))) + "# " + comment;
  document->lines[place.first] = document->lines[place.first].substr(0, place.value) + value + behind;
  document->lines.erase(document->lines.begin() + static_cast<std::ptrdiff_t>(place.first) + 1,
                        document->lines.begin() + static_cast<std::ptrdiff_t>(place.last) + 1);
}

void Insert(Document* document, const std::string& dotted, const std::string& value,
            const std::string& comment) {
  const size_t dot = dotted.rfind('.');
  const std::string section = dot == std::string::npos ? "" : dotted.substr(0, dot);
  const std::string line = dotted.substr(dot == std::string::npos ? 0 : dot + 1) + " = " + value +
                           (comment.empty() ? "" : "  # " + comment);
  const auto end = document->section_ends.find(section);
  if (end != document->section_ends.end()) {
    document->lines.insert(document->lines.begin() + static_cast<std::ptrdiff_t>(end->second), line);
  } else {
    document->lines.insert(document->lines.end(), {"", "[" + section + "]", line});
  }
}

// A value as TomlEntries() writes it.
std::string Canonical(const std::string& value, const std::string& name) {
  const auto entries = TomlEntries(ParseToml("value = " + value, name));
  return entries.size() == 1 ? entries.front().second : value;
}

void CheckResult(const std::string& before, const std::string& after, const std::string& name,
                 const std::vector<TomlEntry>& changed, const std::vector<std::string>& removed) {
  std::map<std::string, std::string> expected;
  for (const auto& [key, value] : TomlEntries(ParseToml(before, name))) expected[key] = value;
  for (const std::string& key : removed) expected.erase(key);
  for (const auto& [key, value] : changed) expected[key] = Canonical(value, name);
  std::map<std::string, std::string> found;
  try {
    for (const auto& [key, value] : TomlEntries(ParseToml(after, name))) found[key] = value;
  } catch (const InputError&) {
    found.clear();  // the addition contradicts the rest, as a [section] does beside an inline table
  }
  if (found == expected) return;
  for (const auto& [key, value] : changed) {
    if (found[key] != expected[key]) {
      throw InputError(name + ": " + key + ": cannot be changed in place to " + value +
                       "; write it as a line of its own under [section]");
    }
  }
  throw InputError(name +
                   ": cannot be changed in place; write each key as a line of its own under its [section]");
}

}  // namespace

std::vector<TomlEntry> TomlEntries(const TomlNode& table) {
  std::vector<TomlEntry> entries;
  Flatten(table, "", entries);
  return entries;
}

std::string EditToml(const std::string& text, const std::string& name, const std::vector<TomlEntry>& changed,
                     const std::vector<std::string>& removed,
                     const std::map<std::string, std::string>& comments) {
  std::string edited = text;
  for (const auto& [key, value] : changed) {
    const auto found = comments.find(key);
    const std::string comment = found == comments.end() ? "" : found->second;
    Document document = Read(edited);
    const auto place = document.keys.find(key);
    if (place != document.keys.end()) {
      Replace(&document, place->second, value, comment);
    } else {
      Insert(&document, key, value, comment);
    }
    edited = Joined(document.lines);
  }
  for (const std::string& key : removed) {
    Document document = Read(edited);
    const auto place = document.keys.find(key);
    if (place == document.keys.end()) continue;
    document.lines.erase(document.lines.begin() + static_cast<std::ptrdiff_t>(place->second.first),
                         document.lines.begin() + static_cast<std::ptrdiff_t>(place->second.last) + 1);
    edited = Joined(document.lines);
  }
  CheckResult(text, edited, name, changed, removed);
  return edited;
}

}  // namespace hydro::settings
