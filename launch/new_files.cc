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

// Of this program: bin/ is in it, beside what programs of the user's own are built on.
fs::path Home() { return fs::path(process::OwnFolder()).parent_path(); }

bool IsBuild() { return fs::exists(Home() / "CMakeCache.txt"); }

// Where CMake finds an installed hydro: lib/cmake/hydro, or lib/ARCHITECTURE/cmake/hydro. Empty: nowhere.
std::string PackageFolder(const fs::path& home) {
  std::vector<fs::path> libraries = {home / "lib", home / "lib64"};
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(home / "lib", none)) libraries.push_back(entry.path());
  for (const fs::path& folder : libraries) {
    const fs::path package = folder / "cmake/hydro";
    if (fs::exists(package / "hydroConfig.cmake", none)) return package.string();
  }
  return "";
}

// As a shell takes it.
std::string ShellWord(const std::string& text) {
  const bool plain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::strchr("/._-+", c) != nullptr;
  });
  if (plain && !text.empty()) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
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
  const fs::path path = Home() / "share/hydro/config" / file;
  if (!fs::exists(path)) {
    throw InputError(
        path.string() +
        ": found no such file, which a build and an installation have beside bin/hydro-launch; run "
        "hydro-launch where it was built (build/bin/hydro-launch), or install it: cmake --install "
        "build --prefix PREFIX");
  }
  return path.string();
}

FirstSteps StepsToBuildOn() {
  const fs::path home = Home();
  const bool python = fs::exists(home / "share/hydro/python/hydro/__init__.py");
  if (IsBuild()) {
    const bool on_path = process::ProgramOnPath("hydro-launch") == process::OwnFolder() + "/hydro-launch";
    const std::string path =
        on_path ? "" : "  export PATH=" + ShellWord(process::OwnFolder()) + ":\"$PATH\"\n";
    const std::string build = "  cmake --build " + ShellWord(home.string()) + " --target ";
    return {.python = path + (python ? "" : build + "hydro_python\n"),
            .cpp = path + build + "hydro_driver      what a driver is built on\n",
            .cmake_options = " -Dhydro_DIR=" + ShellWord(home.string())};
  }
  const std::string missing = "  first install hydro's development files, which are not in " + home.string() +
                              ": package libhydro-dev\n";
  const bool found = !PackageFolder(home).empty();
  const bool usual = home == "/usr" || home == "/usr/local";  // CMake looks there by itself
  return {.python = python ? "" : missing,
          .cpp = found ? "" : missing,
          .cmake_options = usual ? "" : " -DCMAKE_PREFIX_PATH=" + ShellWord(home.string())};
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
