#include "launch/new_driver.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/input_error.h"
#include "launch/new_files.h"
#include "launch/own_driver_texts.h"
#include "settings/toml/toml_document.h"

namespace hydro::launch {
namespace {

constexpr char kExample[] = "udp_box";

}  // namespace

int NewDriver(const std::string& name) {
  CheckNewName("--new-driver", name);
  if (name == "simulated_device") {
    throw InputError(
        "--new-driver: found \"simulated_device\", allowed another name: the device's program has this one");
  }
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
