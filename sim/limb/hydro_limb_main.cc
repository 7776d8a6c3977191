// hydro-limb CONFIG: runs the joints of a limb in one process.
#include <spdlog/spdlog.h>

#include "process/process_main.h"
#include "process/stop_signal.h"
#include "sim/limb/limb_app.h"
#include "tune/design/fastest_motion.h"

int main(int argc, char** argv) {
  hydro::settings::CommandLine command_line(
      "hydro-limb", "Several joints in one process: plant, pressure loop and position loop of each.");
  command_line.AddExamples({"hydro-limb config/limb.toml        hydro-launch starts it with a logger"},
                           "docs/limbs.md");
  hydro::settings::CommonOptions options;
  hydro::limb::LimbAppOptions limb;
  command_line.AddCommon(&options);
  command_line.AddOption("--joints", &limb.joints,
                         "NAME run this joint; again for more. Without it, all that no other process has");
  command_line.AddOption(
      "--expect", &limb.expected,
      "ROLE wait for this process before the run begins, e.g. logger; or for joint:NAME of another one");
  if (const auto exit_code = command_line.Parse(argc, argv)) return *exit_code;
  limb.heartbeat = hydro::process::HeartbeatArrived;
  hydro::settings::LimbConfig config;
  return hydro::process::RunProcess(
      "hydro-limb", options,
      [&](hydro::bus::Bus& bus, hydro::bus::Clock& clock, const hydro::settings::StackConfig&) {
        for (const std::string& remark : hydro::design::RemarksOn(config)) spdlog::warn("{}", remark);
        return hydro::limb::LimbApp(bus, clock, config, limb).Run();
      },
      [&](const std::string& file, const std::vector<std::string>& overrides) {
        config = hydro::settings::LoadLimbConfig(file, overrides);
        return config.common;
      });
}
