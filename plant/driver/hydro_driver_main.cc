// hydro-driver CONFIG: the real actuator, behind a data-acquisition board or a front end.
#include "plant/driver/check_sensors.h"
#include "plant/driver/comedi_device.h"
#include "plant/driver/device_rig.h"
#include "plant/driver/driver_main.h"
#include "plant/driver/guarded_front_end.h"
#include "plant/front_end/check_front_end.h"

int main(int argc, char** argv) {
  using hydro::bus::Clock;
  using hydro::plant::ComediDevice;
  using hydro::settings::StackConfig;
  const auto is_front_end = [](const StackConfig& config) {
    return config.driver->kind == hydro::settings::DriverKind::kFrontEnd;
  };
  hydro::plant::RigProgram program;
  program.name = "hydro-driver";
  program.about =
      "The real actuator behind a data-acquisition board (Comedi) or a front end (a microcontroller): "
      "publishes "
      "the sensors' readings and puts out the pressure loop's commands.";
  program.examples = {"hydro-driver config/driver.toml"};
  program.page = "docs/hardware.md";
  program.make_rig = [&](const StackConfig& config,
                         const Clock& clock) -> std::unique_ptr<hydro::plant::Rig> {
    if (is_front_end(config)) return std::make_unique<hydro::plant::GuardedFrontEnd>(config, clock);
    return std::make_unique<hydro::plant::DeviceRig>(config, clock,
                                                     std::make_unique<ComediDevice>(config, clock, true));
  };
  program.check_sensors = [&](const StackConfig& config, const Clock& clock) {
    if (is_front_end(config)) return hydro::plant::CheckFrontEnd(config, clock);
    ComediDevice device(config, clock, false);
    return hydro::plant::CheckSensors(config, clock, device);
  };
  program.beside = hydro::plant::LeadLoopOnDevice;
  return hydro::plant::RunRigProgram(argc, argv, program);
}
