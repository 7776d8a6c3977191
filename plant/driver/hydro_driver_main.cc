// hydro-driver CONFIG: the real actuator, behind a data-acquisition board.
#include "plant/driver/check_sensors.h"
#include "plant/driver/comedi_device.h"
#include "plant/driver/device_rig.h"
#include "plant/driver/driver_main.h"

int main(int argc, char** argv) {
  using hydro::plant::ComediDevice;
  hydro::plant::RigProgram program;
  program.name = "hydro-driver";
  program.about =
      "The real actuator behind a data-acquisition board (Comedi): publishes the sensors' readings and puts "
      "out the pressure loop's commands.";
  program.examples = {"hydro-driver config/driver.toml"};
  program.page = "docs/hardware.md";
  program.make_rig = [](const hydro::settings::StackConfig& config, const hydro::bus::Clock& clock) {
    return std::make_unique<hydro::plant::DeviceRig>(config, clock,
                                                     std::make_unique<ComediDevice>(config, clock, true));
  };
  program.check_sensors = [](const hydro::settings::StackConfig& config, const hydro::bus::Clock& clock) {
    ComediDevice device(config, clock, false);
    return hydro::plant::CheckSensors(config, clock, device);
  };
  return hydro::plant::RunRigProgram(argc, argv, program);
}
