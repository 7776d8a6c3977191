#include "tune/search/tuned_text.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "base/text_file.h"
#include "base/word_list.h"
#include "settings/config_entries.h"
#include "settings/limb_config.h"
#include "settings/quantity_keys.h"
#include "settings/read_quantities.h"
#include "settings/toml/toml_document.h"
#include "settings/toml/toml_edit.h"
#include "tune/search/gains.h"

namespace hydro::tune {
namespace {

using Values = std::map<std::string, std::string>;

constexpr char kFirstLine[] = "# Gains by hydro-tune";

Values EntriesOf(const std::string& text, const std::string& file) {
  settings::TomlNode document = settings::ParseToml(text, file);
  settings::UsePresentNames(&document);
  const auto entries = settings::TomlEntries(document);
  return {entries.begin(), entries.end()};
}

// Adds the keys that --set changed to `changed` and `removed`, because the text of the file does not have
// them.
void AddOverrides(const settings::StackConfig& given, const std::vector<std::string>& overrides,
                  Values* changed, std::vector<std::string>* removed) {
  if (overrides.empty()) return;
  const Values before = EntriesOf(settings::LoadStackConfig(given.file).text, given.file);
  const Values after = EntriesOf(given.text, given.file);
  for (const auto& [key, value] : after) {
    const auto was = before.find(key);
    if (was == before.end() || was->second != value) (*changed)[key] = value;
  }
  for (const auto& [key, value] : before) {
    if (!after.contains(key)) removed->push_back(key);
  }
}

// The gains of `tuned` that are others than those of the text `before`.
Values ChangedGains(const std::string& before, const settings::StackConfig& given,
                    const settings::StackConfig& tuned) {
  const auto old =
      GainKeys(settings::ParseStackConfig(before, given.file, given.model.text, given.model.file));
  Values changed;
  for (const auto& key : GainKeys(tuned)) {
    if (std::find(old.begin(), old.end(), key) == old.end()) changed.insert(key);
  }
  return changed;
}

// "psi/rad, by hydro-tune, was 10000.0"
std::string Comment(const std::string& key, const std::string& by, const Values& before,
                    const settings::StackConfig& config) {
  const std::string unit = settings::UnitOfKey(key, config.model.description.units, "arm_angle");
  const auto was = before.find(key);
  return (unit.empty() ? "" : unit + ", ") + "by " + by + (was == before.end() ? "" : ", was " + was->second);
}

// "# Gains by hydro-tune, from paper.toml: position.c1 and position.c2. ..."
std::string FirstLine(const TuneRequest& request, const std::string& file, const Values& gains) {
  std::vector<std::string> names;
  for (const auto& [key, value] : gains) names.push_back(key);
  std::string goals;
  for (const std::string& goal : request.goals) goals += " --goal " + goal;
  return std::string(kFirstLine) + goals + ", from " + std::filesystem::path(file).filename().string() +
         ": " + Enumerated(names) + ". Comments that speak of these were written for other values.\n";
}

// The text without the line that an earlier search put first.
std::string WithoutFirstLine(const std::string& text) {
  return text.starts_with(kFirstLine) ? text.substr(std::min(text.find('\n'), text.size() - 1) + 1) : text;
}

}  // namespace

std::string TunedText(const TuneRequest& request, const settings::StackConfig& given,
                      const settings::StackConfig& tuned) {
  const bool limb = settings::IsLimbFile(given.file);
  const std::string before = WithoutFirstLine(limb ? given.text : ReadTextFile(given.file));
  Values written, comments;
  std::vector<std::string> removed;
  const Values was = EntriesOf(before, given.file);
  if (!limb) AddOverrides(given, request.overrides, &written, &removed);
  for (const auto& [key, value] : written) comments[key] = Comment(key, "--set", was, given);
  for (const auto& [key, value] : settings::MovedPaths(given, request.output)) written[key] = value;
  Values gains = ChangedGains(before, given, tuned);
  // What --set gave, and the search kept, is the user's.
  std::erase_if(gains, [&](const auto& gain) {
    const auto set = written.find(gain.first);
    return set != written.end() && set->second == gain.second;
  });
  for (const auto& [key, value] : gains) {
    written[key] = value;
    comments[key] = Comment(key, "hydro-tune", was, given);
  }
  const std::vector<settings::TomlEntry> entries(written.begin(), written.end());
  for (std::string& name : settings::FormerNamesIn(settings::ParseToml(before, given.file), entries))
    removed.push_back(std::move(name));
  const std::string text = settings::EditToml(before, given.file, entries, removed, comments);
  return gains.empty() ? text : FirstLine(request, given.file, gains) + text;
}

void CheckCanBeChanged(const TuneRequest& request, const settings::StackConfig& config) {
  Gains other = GainsOf(config);
  other.as_configured = false;
  for (double* gain : {&other.natural_frequency, &other.damping_ratio, &other.c1, &other.c2})
    *gain = 1.5 * *gain + 1;
  TunedText(request, config, With(config, other));
}

}  // namespace hydro::tune
