#include "launch/new_files.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "base/input_error.h"
#include "base/new_file.h"
#include "base/text_file.h"
#include "process/own_program.h"

namespace hydro::launch {
namespace {

namespace fs = std::filesystem;

InputError IsThere(const std::string& path) {
  return InputError(path + ": is there already and is not overwritten; give another name, or move it away");
}

void WriteNew(const NewFile& file) {
  const int fd = open(file.path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, file.mode);
  if (fd < 0 && errno == EEXIST) throw IsThere(file.path);
  if (fd < 0) {
    throw InputError(file.path + ": cannot be written: " + std::strerror(errno) +
                     "; go to a folder that is yours");
  }
  errno = ENOSPC;  // the reason of a short write
  const bool written =
      write(fd, file.text.data(), file.text.size()) == static_cast<ssize_t>(file.text.size()) &&
      fsync(fd) == 0;
  const std::string why = std::strerror(errno);
  close(fd);
  if (written) return;
  unlink(file.path.c_str());
  throw WriteError(file.path + ": cannot be written: " + why + "; space for it is needed");
}

}  // namespace

void CheckNewName(const std::string& option, const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(),
                                 [](unsigned char c) { return (c < 0x80 && std::isalnum(c)) || c == '_'; });
  if (plain && !name.empty() && name.size() <= 64 && !std::isdigit(static_cast<unsigned char>(name[0])))
    return;
  throw InputError(option + ": found " + Quoted(name) +
                   ", allowed a name of letters, digits and underscores that begins with a letter, without "
                   "anything after a dot");
}

std::string Replaced(std::string text, const std::string& old, const std::string& by) {
  size_t at = text.find(old);
  if (at == std::string::npos) throw std::logic_error("the example has no " + old);
  for (; at != std::string::npos; at = text.find(old, at + by.size())) text.replace(at, old.size(), by);
  return text;
}

std::string InstalledConfig(const std::string& file) {
  const fs::path path = fs::path(process::OwnFolder()).parent_path() / "share/hydro/config" / file;
  if (!fs::exists(path)) {
    throw InputError(path.string() + ": found no such file; install hydro with its configurations");
  }
  return path.string();
}

void WriteNewFiles(const std::vector<NewFile>& files) {
  for (const NewFile& file : files) {
    std::error_code ignored;
    if (fs::symlink_status(file.path, ignored).type() != fs::file_type::not_found) throw IsThere(file.path);
  }
  std::vector<std::string> written;
  try {
    for (const NewFile& file : files) {
      WriteNew(file);
      written.push_back(file.path);
    }
  } catch (...) {
    for (const std::string& path : written) unlink(path.c_str());
    throw;
  }
}

}  // namespace hydro::launch
