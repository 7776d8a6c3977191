#include "settings/agreed_entries.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "settings/toml/toml_entries.h"

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

}  // namespace hydro::settings
