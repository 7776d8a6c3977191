#include "tune/live/saved_config.h"

#include <map>
#include <utility>

#include "base/input_error.h"
#include "base/text_file.h"
#include "settings/config_entries.h"
#include "settings/quantity_keys.h"
#include "settings/read_quantities.h"
#include "settings/toml/toml_edit.h"
#include "tune/live/rearm_forecast.h"
#include "tune/live/tunable_keys.h"

namespace hydro::tuning {
namespace {

// Keys that exclude each other do not fit a table of single values, so reference and pressure are compared as
// a whole.
bool Concerned(const std::string& key) {
  return tuning::FindTunable(key) != nullptr || key.starts_with("reference.") || key.starts_with("pressure.");
}

std::map<std::string, std::string> Entries(const settings::TomlNode& document) {
  std::map<std::string, std::string> entries;
  for (const auto& [key, value] : settings::TomlEntries(document)) {
    if (Concerned(key)) entries.emplace(key, value);
  }
  return entries;
}

}  // namespace

std::map<std::string, std::string> ValuesInForce(const run_description_t& run,
                                                 const tuned_settings_t& in_force,
                                                 const std::function<std::string(double)>& text) {
  std::map<std::string, std::string> values;
  for (size_t i = 0; i < in_force.names.size(); ++i) values[in_force.names[i]] = text(in_force.values[i]);
  const settings::StackConfig config = tuning::ConfigInForce(run, in_force);
  for (auto& [key, value] : settings::TomlEntries(settings::ParseToml(config.text, config.file))) {
    values[key] = std::move(value);
  }
  return values;
}

std::string SavedText(const std::string& file, const std::string& joint, const std::string& output,
                      const run_description_t& run, const tuned_settings_t& in_force) {
  const settings::StackConfig config = tuning::ConfigInForce(run, in_force);
  if (file.empty()) return config.text;
  if (!joint.empty()) {
    const settings::StackConfig given = settings::LoadStackConfig(file, {"joint=" + joint});
    return settings::EditToml(config.text, file, settings::MovedPaths(given, output), {});
  }
  const std::string text = ReadTextFile(file);
  settings::TomlNode document = settings::ParseToml(text, file);
  std::map<std::string, std::string> written;  // by present name, as written in the file
  for (const auto& [key, value] : settings::TomlEntries(document)) written[settings::PresentName(key)] = key;
  // A text with a unit that gives the same number stays.
  settings::ReadQuantities(&document, config.model.description.units);
  const auto before = Entries(document), after = Entries(settings::ParseToml(config.text, file));
  std::vector<settings::TomlEntry> changed = settings::MovedPaths(settings::LoadStackConfig(file), output);
  std::vector<std::string> removed;
  for (const auto& [key, value] : after) {
    const auto was = before.find(key);
    if (was != before.end() && was->second == value) continue;
    changed.emplace_back(key, value);
    if (was != before.end() && written[key] != key) removed.push_back(written[key]);
  }
  for (const auto& [key, value] : before) {
    if (!after.contains(key)) removed.push_back(written[key]);
  }
  return settings::EditToml(text, file, changed, removed);
}

}  // namespace hydro::tuning
