#include "runs/sidecar_search.h"

#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "base/text_file.h"
#include "base/word_list.h"
#include "settings/toml/toml_document.h"

namespace hydro::runs {
namespace {

namespace fs = std::filesystem;

constexpr uintmax_t kLargest = 1u << 20;  // bytes; no sidecar is larger

// The folder's TOML files by name, whatever they contain.
std::vector<std::string> TomlFiles(const fs::path& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end;
       at.increment(error)) {
    if (at->path().extension() != ".toml" || !at->is_regular_file(error)) continue;
    if (at->file_size(error) <= kLargest) files.push_back((folder / at->path().filename()).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Whether the file has a pattern that matches this name. A file that is not TOML, or cannot be read, is not a
// sidecar.
bool Serves(const std::string& file, const std::string& name) {
  try {
    const settings::TomlNode root = settings::ParseToml(ReadTextFile(file), file);
    const settings::TomlNode* pattern = root.Find("tables");
    return pattern != nullptr && pattern->is(settings::TomlNode::Kind::kString) &&
           fnmatch(pattern->text.c_str(), name.c_str(), 0) == 0;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

SidecarFile FindSidecar(const std::string& table) {
  const std::string own = fs::path(table).replace_extension(".toml").string();
  if (fs::exists(own)) return {own, false};
  const std::string name = fs::path(table).filename().string();
  std::vector<std::string> serving;
  for (const std::string& file : TomlFiles(fs::path(table).parent_path())) {
    if (Serves(file, name)) serving.push_back(file);
  }
  if (serving.size() == 1) return {serving.front(), true};
  if (serving.empty()) {
    throw InputError(
        table + ": found no " + own +
        " beside it, nor another sidecar there whose `tables` is a pattern of its name, allowed a "
        "table with a sidecar that has shaft and [columns] with time and voltage");
  }
  throw InputError(table + ": found " + std::to_string(serving.size()) +
                   " sidecars whose `tables` fit its name (" + Joined(serving) +
                   "), allowed one: narrow a pattern, or write " + own);
}

}  // namespace hydro::runs
