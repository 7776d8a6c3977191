// Makes a driver of one's own in a few lines (docs/own_driver.md):
//
//   int main(int argc, char** argv) {
//     return hydro::plant::RunDriver(argc, argv, "The crane's drive.", [](hydro::plant::DeviceSettings& s) {
//       return std::make_unique<Crane>(s);   // a hydro::plant::Device
//     });
//   }
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bus/clock.h"
#include "plant/driver/device.h"
#include "plant/rig.h"
#include "settings/stack_config.h"

namespace hydro::bus {
class Bus;
}

namespace hydro::plant {

// Opens the device that the configuration names. Throws InputError, or DeviceError when the device does not
// answer.
using OpenDevice = std::function<std::unique_ptr<Device>(DeviceSettings& settings)>;

// A whole program in the place of hydro-driver, with everything that hydro-driver does: it takes the
// configuration from the command line, or from HYDRO_CONFIG and HYDRO_SET as hydro-launch sets them; it has
// --check-sensors and --help; it handles the loops' commands, limits, faults, statistics and the stack's key;
// it puts out zero volts on every way out. Returns the exit code; an error is one line on stderr.
int RunDriver(int argc, char** argv, const std::string& about, const OpenDevice& open);

// The same for a program that adds more than a Device, as hydro-driver does.
struct RigProgram {
  std::string name;  // hydro-driver; else "driver", a program of the user's own
  std::string about;
  std::vector<std::string> examples;
  std::string page;  // of the documentation
  std::function<std::unique_ptr<Rig>(const settings::StackConfig&, const bus::Clock&)> make_rig;
  std::function<int(const settings::StackConfig&, const bus::Clock&)> check_sensors;  // returns the exit code
  // Begins what else this process does in the run of a rig; the function that it returns is called after the
  // run. Either function may be empty.
  std::function<std::function<void()>(bus::Bus&, bus::Clock&, const settings::StackConfig&, Rig&)> beside =
      {};
};
int RunRigProgram(int argc, char** argv, const RigProgram& program);

}  // namespace hydro::plant
