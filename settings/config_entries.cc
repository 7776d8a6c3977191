#include "settings/config_entries.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

#include "base/text_file.h"
#include "settings/toml/toml_document.h"
#include "settings/toml/toml_edit.h"

namespace hydro::settings {
namespace {

constexpr std::array<std::string_view, 7> kSections{"bus.",    "logger.", "noise.",    "driver.",
                                                    "process", "scope.",  "model.file"};
constexpr std::array<std::string_view, 7> kKeys{
    "time.duration_s",          "time.start_timeout_s", "time.stall_timeout_s", "plant.integrator",
    "plant.relative_tolerance", "reference.file",       "model.motion.file"};

bool ConcernsOne(std::string_view key) {
  return std::any_of(kSections.begin(), kSections.end(),
                     [&](auto section) { return key.starts_with(section); }) ||
         std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
}

}  // namespace

std::string AgreedEntries(const StackConfig& config) {
  std::vector<std::string> lines{std::string("version = '") + HYDRO_VERSION + "'"};
  for (const auto& [key, value] : TomlEntries(ParseToml(config.text, config.file))) {
    if (!ConcernsOne(key)) lines.push_back(key + " = " + value);
  }
  for (const auto& [key, value] : TomlEntries(ParseToml(config.model.text, config.model.resolved_file))) {
    lines.push_back("model file: " + key + " = " + value);
  }
  std::sort(lines.begin(), lines.end());
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::vector<TomlEntry> MovedPaths(const StackConfig& config, const std::string& output) {
  std::vector<TomlEntry> moved;
  const std::filesystem::path folder = std::filesystem::absolute(output).parent_path();
  const auto add = [&](const std::string& key, const std::string& given) {
    if (given.empty() || std::filesystem::path(given).is_absolute()) return;
    const std::string path =
        std::filesystem::proximate(std::filesystem::weakly_canonical(PathBeside(config.file, given)),
                                   std::filesystem::weakly_canonical(folder))
            .string();
    if (path != given) moved.emplace_back(key, TomlString(path));
  };
  add("model.file", config.model.file);
  add("bus.key_file", config.bus.key_file);
  add("reference.file", config.reference.trajectory.file);
  return moved;
}

}  // namespace hydro::settings
