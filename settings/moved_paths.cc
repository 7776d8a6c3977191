#include "settings/moved_paths.h"

#include <filesystem>

#include "base/text_file.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {

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
