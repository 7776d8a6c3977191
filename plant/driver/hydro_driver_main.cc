// hydro-driver CONFIG: the real actuator, behind a data-acquisition board.
#include "plant/driver/board_rig.h"
#include "plant/driver/check_sensors.h"
#include "plant/plant_app.h"
#include "process/process_main.h"
#include "process/stop_signal.h"
#include "process/supervision.h"

namespace {

int CheckSensors(const hydro::settings::CommonOptions& options) {
  const hydro::settings::StackConfig config =
      hydro::settings::LoadStackConfig(options.config, options.overrides);
  hydro::settings::CheckDriver(config);
  hydro::process::CatchStopSignals();
  return hydro::plant::CheckSensors(config, hydro::bus::WallClock());
}

}  // namespace

int main(int argc, char** argv) {
  hydro::settings::CommandLine command_line(
      "hydro-driver",
      "The real actuator behind a data-acquisition board (Comedi): publishes the sensors' readings and puts "
      "out the pressure loop's commands.");
  command_line.AddExamples({"hydro-driver config/driver.toml"}, "docs/hardware.md");
  hydro::settings::CommonOptions options;
  std::vector<std::string> expected;
  bool check_sensors = false;
  command_line.AddCommon(&options);
  command_line.AddOption(
      "--expect", &expected,
      "ROLE also wait for this process, besides the two controllers, e.g. logger; or for joint:NAME of "
      "the same limb");
  command_line.AddFlag("--check-sensors", &check_sensors,
                       "print the sensors' readings and drive nothing, for --duration or until stopped");
  if (const auto exit_code = command_line.Parse(argc, argv)) return *exit_code;
  if (check_sensors)
    return hydro::settings::RunProgram("hydro-driver", [&] { return CheckSensors(options); });
  return hydro::process::RunProcess(
      "hydro-driver", options,
      [&](hydro::bus::Bus& bus, hydro::bus::Clock& clock, const hydro::settings::StackConfig& config) {
        hydro::settings::CheckDriver(config);
        hydro::plant::BoardRig rig(config, clock);
        return hydro::plant::PlantApp(bus, clock, config, rig, expected, "hydro-driver",
                                      hydro::process::HeartbeatArrived)
            .Run();
      });
}
