#include "settings/toml/toml_entries.h"

#include <algorithm>

#include "base/number_text.h"

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

}  // namespace

std::vector<TomlEntry> TomlEntries(const TomlNode& table) {
  std::vector<TomlEntry> entries;
  Flatten(table, "", entries);
  return entries;
}

}  // namespace hydro::settings
