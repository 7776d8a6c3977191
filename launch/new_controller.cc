#include "launch/new_controller.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/input_error.h"
#include "base/new_file.h"
#include "base/text_file.h"
#include "launch/own_controller_texts.h"
#include "process/own_program.h"
#include "settings/toml/toml_document.h"

namespace hydro::launch {
namespace {

namespace fs = std::filesystem;

// A name that Python can import and a shell takes as it is.
void CheckName(const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(),
                                 [](unsigned char c) { return (c < 0x80 && std::isalnum(c)) || c == '_'; });
  if (plain && !name.empty() && name.size() <= 64 && !std::isdigit(static_cast<unsigned char>(name[0])))
    return;
  throw InputError(
      "--new-controller: found " + Quoted(name) +
      ", allowed a name of letters, digits and underscores that begins with a letter, without .py");
}

std::string Replaced(std::string text, const std::string& old, const std::string& by) {
  size_t at = text.find(old);
  if (at == std::string::npos) throw std::logic_error("the example has no " + old);
  for (; at != std::string::npos; at = text.find(old, at + by.size())) text.replace(at, old.size(), by);
  return text;
}

// Unlike other files, these never take the place of what is there: somebody may have worked on it.
void WriteNew(const std::string& file, const std::string& text, mode_t mode) {
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (fd < 0 && errno == EEXIST) {
    throw InputError(file + ": is there already and is not overwritten; give another name, or move it away");
  }
  if (fd < 0) {
    throw InputError(file + ": cannot be written: " + std::strerror(errno) +
                     "; go to a folder that is yours");
  }
  errno = ENOSPC;  // of a write that is shorter
  const bool written =
      write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size()) && fsync(fd) == 0;
  const std::string why = std::strerror(errno);
  close(fd);
  if (written) return;
  unlink(file.c_str());
  throw WriteError(file + ": cannot be written: " + why + "; space for it is needed");
}

}  // namespace

int NewController(const std::string& name) {
  CheckName(name);
  const std::string program = name + ".py", stack = name + ".toml";
  const fs::path model =
      fs::path(process::OwnFolder()).parent_path() / "share/hydro/config/models/table1.toml";
  if (!fs::exists(model)) {
    throw InputError(model.string() + ": found no such model; install hydro with its configurations");
  }
  const std::string python = Replaced(kControllerPython, "pid.py", program);
  std::string toml =
      Replaced(kControllerStack, "hydro-launch examples/own_controller/own.toml", "hydro-launch " + stack);
  toml = Replaced(toml, "pid.py", program);
  toml = Replaced(toml, "\"../../config/models/table1.toml\"", settings::TomlString(model.string()));
  if (fs::exists(stack)) WriteNew(stack, "", 0666);  // throws before anything is written
  WriteNew(program, python, 0777);
  try {
    WriteNew(stack, toml, 0666);
  } catch (...) {
    unlink(program.c_str());
    throw;
  }
  std::printf(
      "wrote %s, a position loop, and %s, a stack with it; next:\n"
      "  hydro-launch %s --duration 3 --log %s.lcmlog    it runs as it is\n"
      "  change answer() in %s, and run it again; --time lockstep: as fast as it can, the same each time\n"
      "  hydro-log summary %s.lcmlog; hydro-log replay --controller ./%s %s.lcmlog\n"
      "docs/own_controller.md says more\n",
      program.c_str(), stack.c_str(), stack.c_str(), name.c_str(), program.c_str(), name.c_str(),
      program.c_str(), name.c_str());
  return 0;
}

}  // namespace hydro::launch
