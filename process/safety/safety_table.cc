#include "process/safety/safety_table.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "base/input_error.h"
#include "process/safety/safety_table_text.h"
#include "settings/toml/toml_document.h"

namespace hydro::process {
namespace {

using settings::TomlMember;
using settings::TomlNode;

constexpr SafeOutput kOutputs[] = {SafeOutput::kZeroVolts, SafeOutput::kReferenceRamped,
                                   SafeOutput::kNotObeyed, SafeOutput::kControlGoesOn};
constexpr Cleared kWaysOut[] = {Cleared::kByItself, Cleared::kByRearm, Cleared::kRunEnds};

InputError Unknown(const TomlNode& node, const std::string& name) {
  return InputError(node.place + ": found '" + name + "', which process/safety/safety_table.h does not know");
}

// The value with that name.
template <class Values>
auto Named(const Values& values, const TomlNode& node, const std::string& name) {
  const auto found =
      std::find_if(std::begin(values), std::end(values), [&](auto value) { return NameOf(value) == name; });
  if (found == std::end(values)) throw Unknown(node, name);
  return *found;
}

// "a text", or { text = "a text", ticks = 5, after = "stale_input_s" }.
Within WithinOf(const TomlNode& node) {
  if (node.is(TomlNode::Kind::kString)) return {.text = node.text};
  Within within;
  for (const auto& [key, value] : node.members) {
    if (key == "text") {
      within.text = value.text;
    } else if (key == "ticks") {
      within.ticks = static_cast<int>(value.integer);
    } else if (key == "after") {
      within.after = value.text;
    } else {
      throw Unknown(value, key);
    }
  }
  return within;
}

// { by_itself = "a text" }, with explicit = "by_rearm" where that differs.
void ReadCleared(const TomlNode& node, SafetyRow* row) {
  const TomlMember& first = node.members.at(0);
  row->restart = row->explicit_rearm = Named(kWaysOut, node, first.first);
  row->cleared_text = first.second.text;
  for (size_t i = 1; i < node.members.size(); ++i) {
    const auto& [key, value] = node.members[i];
    if (key != "explicit") throw Unknown(value, key);
    row->explicit_rearm = Named(kWaysOut, value, value.text);
  }
}

void ReadKey(const std::string& key, const TomlNode& node, SafetyRow* row) {
  if (key == "within") {
    row->within = WithinOf(node);
  } else if (key == "output") {
    const TomlMember& only = node.members.at(0);
    row->output = Named(kOutputs, node, only.first);
    row->output_text = only.second.text;
  } else if (key == "cleared") {
    ReadCleared(node, row);
  } else {
    std::string_view* const text = key == "fault"          ? &row->fault
                                   : key == "detected"     ? &row->detected
                                   : key == "codes"        ? &row->codes
                                   : key == "tests"        ? &row->tests
                                   : key == "injected"     ? &row->injected
                                   : key == "not_injected" ? &row->not_injected
                                                           : nullptr;
    if (text == nullptr) throw Unknown(node, key);
    *text = node.text;
  }
}

}  // namespace

std::string_view NameOf(SafeOutput output) {
  switch (output) {
    case SafeOutput::kZeroVolts:
      return "zero_volts";
    case SafeOutput::kReferenceRamped:
      return "reference_ramped";
    case SafeOutput::kNotObeyed:
      return "not_obeyed";
    case SafeOutput::kControlGoesOn:
      return "control_goes_on";
  }
  return "";
}

std::string_view NameOf(Cleared cleared) {
  switch (cleared) {
    case Cleared::kByItself:
      return "by_itself";
    case Cleared::kByRearm:
      return "by_rearm";
    case Cleared::kRunEnds:
      return "run_ends";
  }
  return "";
}

std::vector<SafetyRow> ReadSafetyTable(const TomlNode& document) {
  std::vector<SafetyRow> rows;
  for (const auto& [id, keys] : document.members) {
    SafetyRow& row = rows.emplace_back();
    row.id = id;
    for (const auto& [key, node] : keys.members) ReadKey(key, node, &row);
  }
  return rows;
}

const std::vector<SafetyRow>& SafetyTable() {
  static const TomlNode document = settings::ParseToml(kSafetyTableText, "process/safety/safety_table.toml");
  static const std::vector<SafetyRow> table = ReadSafetyTable(document);
  return table;
}

const SafetyRow& SafetyRowOf(std::string_view id) {
  const std::vector<SafetyRow>& table = SafetyTable();
  const auto found = std::find_if(table.begin(), table.end(), [&](const SafetyRow& r) { return r.id == id; });
  if (found == table.end()) throw std::invalid_argument("no row of the safety table is " + std::string(id));
  return *found;
}

int TicksWithin(std::string_view id) {
  const std::optional<int> ticks = SafetyRowOf(id).within.ticks;
  if (!ticks)
    throw std::invalid_argument("the row " + std::string(id) + " of the safety table states no ticks");
  return *ticks;
}

std::vector<std::string_view> WordsOf(std::string_view list) {
  std::vector<std::string_view> words;
  while (!list.empty()) {
    const size_t end = std::min(list.find(' '), list.size());
    words.push_back(list.substr(0, end));
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return words;
}

}  // namespace hydro::process
