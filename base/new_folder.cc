#include "base/new_folder.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "base/input_error.h"
#include "base/new_file.h"

namespace hydro {

NewFolder::NewFolder(const std::string& folder) : name_(folder) {
  while (name_.size() > 1 && name_.ends_with('/')) name_.pop_back();
  std::error_code failed;
  const bool there = std::filesystem::exists(name_, failed);
  if (there && !(std::filesystem::is_directory(name_, failed) && std::filesystem::is_empty(name_, failed))) {
    throw InputError(
        folder + ": found something that is there already, allowed is the name of a new or an empty folder");
  }
  for (int i = 0;; ++i) {
    path_ = name_ + ".part" + (i == 0 ? "" : std::to_string(i));
    if (mkdir(path_.c_str(), 0777) == 0) return;
    if (errno == EEXIST) continue;
    throw InputError(folder + ": cannot be created: " + std::strerror(errno) +
                     "; a new folder in an existing, writable one is needed");
  }
}

NewFolder::~NewFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

void NewFolder::Finish() {
  std::error_code failed;
  std::filesystem::rename(path_, name_, failed);  // replaces an empty folder
  if (failed) throw WriteError(name_ + ": cannot be written: " + failed.message());
  path_.clear();
}

}  // namespace hydro
