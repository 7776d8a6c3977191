#include "runs/run_config.h"

#include <algorithm>

#include "base/input_error.h"
#include "base/number_text.h"
#include "settings/model_file.h"
#include "settings/toml/toml_document.h"

namespace hydro::runs {
namespace {

using settings::TomlNode;
using Kind = TomlNode::Kind;

// A log is untrusted input: its text goes through the only reader of TOML.
TomlNode Parse(const std::string& text, const std::string& file, const std::string& what) {
  return settings::ParseToml(text, file + ": run description: " + what);
}

std::vector<const settings::TomlMember*> SortedMembers(const TomlNode& table) {
  std::vector<const settings::TomlMember*> members;
  for (const settings::TomlMember& member : table.members) members.push_back(&member);
  std::ranges::sort(members, {}, &settings::TomlMember::first);
  return members;
}

// A literal string where possible, which needs no escapes.
std::string StringText(const std::string& text) {
  const bool literal =
      std::ranges::none_of(text, [](unsigned char c) { return c == '\'' || c < 0x20 || c == 0x7f; });
  return literal ? "'" + text + "'" : settings::TomlString(text);
}

// A value as TOML on one line; numbers as they are read, in the shortest form.
std::string ValueText(const TomlNode& node) {
  std::string text;
  switch (node.kind) {
    case Kind::kTable:
      for (const settings::TomlMember* member : SortedMembers(node)) {
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
  for (const settings::TomlMember* member : SortedMembers(table)) {
    const std::string name = prefix + member->first;
    if (member->second.is(Kind::kTable)) {
      Flatten(member->second, name + ".", entries);
    } else {
      entries.emplace_back(name, ValueText(member->second));
    }
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> ConfigEntries(const run_description_t& description,
                                                               const std::string& file) {
  std::vector<std::pair<std::string, std::string>> entries;
  Flatten(Parse(description.config_text, file, "configuration"), "", entries);
  return entries;
}

int CommandDelayTicks(const run_description_t& description, const std::string& file) {
  const TomlNode config = Parse(description.config_text, file, "configuration");
  const TomlNode* plant = config.Find("plant");
  const TomlNode* delay = plant == nullptr ? nullptr : plant->Find("command_delay_ticks");
  if (delay == nullptr) return 1;
  if (!delay->is_number() || (delay->AsDouble() != 0 && delay->AsDouble() != 1)) {
    throw InputError(delay->place + ": plant.command_delay_ticks: found " + delay->Shown() +
                     ", allowed 0 or 1");
  }
  return static_cast<int>(delay->AsDouble());
}

std::string ModelName(const run_description_t& description, const std::string& file) {
  const TomlNode model = Parse(description.model_text, file, "model");
  const TomlNode* name = model.Find("name");
  return name != nullptr && name->is(Kind::kString) ? name->text : std::string();
}

UnitSystem ModelUnits(const run_description_t& description, const std::string& file) {
  return settings::ParseModelUnits(description.model_text, file + " (model)");
}

}  // namespace hydro::runs
