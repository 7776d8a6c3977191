#include "runs/run_config.h"

#include <algorithm>
#include <utility>

#include "base/input_error.h"
#include "settings/model_file.h"
#include "settings/toml/toml_document.h"
#include "settings/toml/toml_entries.h"

namespace hydro::runs {
namespace {

using settings::TomlNode;

// A log is untrusted input, so its text goes through the only reader of TOML.
TomlNode Parse(const std::string& text, const std::string& file, const std::string& what) {
  return settings::ParseToml(text, file + ": run description: " + what);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> ConfigEntries(const run_description_t& description,
                                                               const std::string& file) {
  TomlNode root = Parse(description.config_text, file, "configuration");
  // For a limb, also the joints' own sections, by name.
  std::vector<settings::TomlEntry> entries;
  if (const TomlNode* joints = root.Find("joint"); joints != nullptr && joints->is(TomlNode::Kind::kArray)) {
    for (const TomlNode& joint : joints->items) {
      const TomlNode* name = joint.is(TomlNode::Kind::kTable) ? joint.Find("name") : nullptr;
      const std::string shown = name != nullptr ? name->text : "?";
      for (auto& [key, value] : settings::TomlEntries(joint))
        entries.emplace_back("joint." + shown + "." + key, value);
    }
    root.Erase("joint");
  }
  for (auto& entry : settings::TomlEntries(root)) entries.push_back(std::move(entry));
  std::sort(entries.begin(), entries.end());
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
  return name != nullptr && name->is(TomlNode::Kind::kString) ? name->text : std::string();
}

UnitSystem ModelUnits(const run_description_t& description, const std::string& file) {
  return settings::ParseModelUnits(description.model_text, file + " (model)");
}

}  // namespace hydro::runs
