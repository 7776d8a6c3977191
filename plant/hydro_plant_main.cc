// hydro-plant CONFIG: the simulated actuator.
#include <spdlog/spdlog.h>

#include "plant/plant_app.h"
#include "plant/simulated_rig.h"
#include "process/process_main.h"
#include "process/stop_signal.h"
#include "tune/design/fastest_motion.h"

int main(int argc, char** argv) {
  hydro::settings::CommandLine command_line(
      "hydro-plant", "The simulated actuator: sets the pace, publishes states, obeys motor commands.");
  command_line.AddExamples(
      {"hydro-plant config/demo.toml        with the two controllers beside it; hydro-launch starts all"},
      "docs/launch.md");
  hydro::settings::CommonOptions options;
  std::vector<std::string> expected;
  command_line.AddCommon(&options);
  command_line.AddOption(
      "--expect", &expected,
      "ROLE also wait for this process, besides the two controllers, e.g. logger; or for joint:NAME of "
      "the same limb");
  if (const auto exit_code = command_line.Parse(argc, argv)) return *exit_code;
  return hydro::process::RunProcess(
      "hydro-plant", options,
      [&](hydro::bus::Bus& bus, hydro::bus::Clock& clock, const hydro::settings::StackConfig& config) {
        hydro::plant::SimulatedRig rig(config);  // first: a refusal is to be the only output
        for (const std::string& remark : hydro::design::RemarksOn(config)) spdlog::warn("{}", remark);
        return hydro::plant::PlantApp(bus, clock, config, rig, expected, "hydro-plant",
                                      hydro::process::HeartbeatArrived)
            .Run();
      });
}
