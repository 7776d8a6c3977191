#include "launch/starters.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_error.h"
#include "base/new_file.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "bus/seal/bus_key.h"
#include "launch/own_controller_texts.h"
#include "launch/own_driver_texts.h"
#include "process/own_program.h"
#include "settings/limb_config.h"
#include "settings/toml/toml_document.h"

namespace hydro::launch {
namespace {

// Writes the files that hydro-launch new-controller and new-driver make from the examples, as a start for the
// user.

// The steps that come before those of the files themselves, one to a line and indented, where this
// hydro-launch was built and not installed, or was installed without its development files.
struct FirstSteps {
  std::string python;         // for a program in Python; empty: none
  std::string cpp;            // for one in C++; empty: none
  std::string cmake_options;  // " -Dhydro_DIR=...", for CMake to find hydro; empty: it does
};

struct NewFile {
  std::string path;
  std::string text;
  mode_t mode = 0666;
};

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

// Throws InputError, which begins with `option`, for a name that Python, CMake or a shell would not take
// unchanged.
void CheckNewName(const std::string& option, const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(),
                                 [](unsigned char c) { return (c < 0x80 && std::isalnum(c)) || c == '_'; });
  if (plain && !name.empty() && name.size() <= 64 && !std::isdigit(static_cast<unsigned char>(name[0])))
    return;
  throw InputError(option + ": found " + Quoted(name) +
                   ", allowed a name of at most 64 letters, digits and underscores, no digit first, and no "
                   "ending (.py, .cc)");
}

// What the driver's program, CMake's target and the file in its folder may not be called: targets that CMake
// or its generators make, and files that they write where the program would be.
constexpr std::string_view kTakenByCMake =
    " ALL_BUILD CMakeFiles INSTALL Makefile PACKAGE RUN_TESTS Testing ZERO_CHECK all clean "
    "cmake_check_build_system cmake_force codegen default_target depend edit_cache help install "
    "list_install_components package package_source preinstall rebuild_cache test ";

// A program in Python finds its own file first where it imports a module of the same name: these are those
// that it imports, and those that these import.
constexpr std::string_view kTakenByPython =
    " array collections enum errno hydro hydro_bus io math os re select selectors signal socket struct sys "
    "time ";

void CheckNewControllerName(const std::string& name) {
  CheckNewName("--new-controller", name);
  if (kTakenByPython.find(" " + name + " ") == std::string_view::npos) return;
  throw InputError("--new-controller: found " + Quoted(name) + ", allowed another name, e.g. my_" + name +
                   ": the controller imports a Python module of this name");
}

void CheckNewDriverName(const std::string& name) {
  CheckNewName("--new-driver", name);
  const std::string allowed = ", allowed another name, e.g. my_" + name + ": ";
  if (name == "simulated_device")
    throw InputError("--new-driver: found " + Quoted(name) + allowed + "the device's program has this one");
  if (kTakenByCMake.find(" " + name + " ") != std::string_view::npos)
    throw InputError("--new-driver: found " + Quoted(name) + allowed +
                     "CMake has a target or file of this name");
}

// Throws std::logic_error when `old` is not in `text`.
std::string Replaced(std::string text, const std::string& old, const std::string& by) {
  size_t at = text.find(old);
  if (at == std::string::npos) throw std::logic_error("the example has no " + old);
  for (; at != std::string::npos; at = text.find(old, at + by.size())) text.replace(at, old.size(), by);
  return text;
}

// The path of an installed file under share/hydro/config. Throws InputError when it is not there.
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

// Writes all of the files or none. Unlike other files, these never replace an existing file: somebody may
// have worked on it. Throws InputError.
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

constexpr char kExample[] = "udp_box";

}  // namespace

int MakeKey(const settings::CommonOptions& options) {
  const settings::StackConfig config = settings::LoadCommonConfig(options.config, options.overrides);
  const std::string& file = config.bus.resolved_key_file;
  if (file.empty()) {
    throw InputError(options.config +
                     ": bus.key_file: found nothing, allowed is the path of the key file to create");
  }
  bus::MakeBusKeyFile(file);
  std::printf(
      "%s: a new key, readable by you alone; every host of the stack needs a copy (docs/security.md)\n",
      file.c_str());
  return 0;
}

int NewController(const std::string& name) {
  CheckNewControllerName(name);
  const std::string program = name + ".py", stack = name + ".toml";
  const std::string model = InstalledConfig("models/table1.toml");
  std::string toml =
      Replaced(kControllerStack, "hydro-launch examples/own_controller/own.toml", "hydro-launch " + stack);
  toml = Replaced(toml, "pid.py", program);
  toml = Replaced(toml, "\"../../config/models/table1.toml\"", settings::TomlString(model));
  WriteNewFiles({{program, Replaced(kControllerPython, "pid.py", program), 0777}, {stack, toml}});
  std::printf(
      "wrote %s, a position loop, and %s, a stack with it; next:\n"
      "%s"
      "  hydro-launch %s --duration 3 --log %s.lcmlog    it runs as it is\n"
      "  change answer() in %s, and run it again; --time lockstep: as fast as it can, the same each time\n"
      "  hydro-log summary %s.lcmlog; hydro-log replay --controller ./%s %s.lcmlog\n"
      "docs/own_controller.md says more\n",
      program.c_str(), stack.c_str(), StepsToBuildOn().python.c_str(), stack.c_str(), name.c_str(),
      program.c_str(), name.c_str(), program.c_str(), name.c_str());
  return 0;
}

int NewDriver(const std::string& name) {
  CheckNewDriverName(name);
  const std::string model = InstalledConfig("models/table1.toml");
  const std::string toml = Replaced(Replaced(kDriverStack, kExample, name),
                                    "\"../../../config/models/table1.toml\"", settings::TomlString(model));
  const auto path = [&](const std::string& file) { return name + "/" + file; };
  if (mkdir(name.c_str(), 0777) != 0) {
    throw InputError(
        name +
        (errno == EEXIST
             ? ": is there already and is not overwritten; give another name, or move it away"
             : std::string(": cannot be made: ") + std::strerror(errno) + "; go to a folder that is yours"));
  }
  try {
    WriteNewFiles({{path(name + ".cc"), kDriverSource},
                   {path("frames.h"), kDriverFrames},
                   {path("simulated_device.cc"), kDriverDevice},
                   {path(name + ".toml"), toml},
                   {path("CMakeLists.txt"), Replaced(kDriverCMake, kExample, name)}});
  } catch (...) {
    rmdir(name.c_str());
    throw;
  }
  const char* const n = name.c_str();
  const FirstSteps first = StepsToBuildOn();
  std::printf(
      "wrote %s/: %s.cc, a driver for a box on Ethernet, simulated_device.cc, which stands for that box, and "
      "%s.toml, a stack with both; next:\n"
      "%s"
      "  cmake -S %s -B %s/build%s && cmake --build %s/build\n"
      "  hydro-launch %s/%s.toml              it runs as it is, and nothing real moves\n"
      "  hydro-driver-check %s/%s.toml        what docs/safety.md promises, tried with your driver\n"
      "docs/own_driver.md says how to go on to a device of your own\n",
      n, n, n, first.cpp.c_str(), n, n, first.cmake_options.c_str(), n, n, n, n, n);
  return 0;
}

}  // namespace hydro::launch
