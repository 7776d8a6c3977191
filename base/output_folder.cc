#include "base/output_folder.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "base/input_error.h"
#include "base/text_file.h"

namespace hydro {
namespace {

namespace fs = std::filesystem;

fs::path FirstMissing(fs::path folder) {
  fs::path missing;
  std::error_code error;
  for (; !folder.empty() && !fs::exists(folder, error) && !error; folder = folder.parent_path())
    missing = folder;
  return missing;
}

}  // namespace

OutputFolder::OutputFolder(const std::string& folder, const std::string& option)
    : folder_(fs::path(folder + "/").parent_path()), first_made_(FirstMissing(folder_)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (!error && !fs::is_directory(folder_)) error = std::make_error_code(std::errc::not_a_directory);
  if (!error && access(folder_.c_str(), W_OK | X_OK) != 0)
    error = std::error_code(errno, std::generic_category());
  if (error) {
    throw InputError(option + ": found " + Quoted(folder) + ", a folder that cannot be written (" +
                     error.message() + "), allowed a folder that can be written");
  }
}

OutputFolder::~OutputFolder() {
  if (first_made_.empty()) return;
  std::error_code error;
  for (fs::path made = folder_; fs::is_empty(made, error) && !error; made = made.parent_path()) {
    fs::remove(made, error);
    if (error || made == first_made_) return;
  }
}

}  // namespace hydro
