// hydro-pressure-ctrl CONFIG: the fast pressure loop, eq. (16).
#include "pressure_ctrl/pressure_app.h"
#include "process/process_main.h"

int main(int argc, char** argv) {
  hydro::settings::CommandLine command_line(
      "hydro-pressure-ctrl", "The fast pressure loop: a motor command for each plant tick, eq. (16).");
  command_line.AddExamples(
      {"hydro-pressure-ctrl config/demo.toml        beside a plant; hydro-launch starts all"},
      "docs/launch.md");
  hydro::settings::CommonOptions options;
  command_line.AddCommon(&options);
  if (const auto exit_code = command_line.Parse(argc, argv)) return *exit_code;
  return hydro::process::RunProcess(
      "hydro-pressure-ctrl", options,
      [](hydro::bus::Bus& bus, hydro::bus::Clock& clock, const hydro::settings::StackConfig& config) {
        hydro::pressure_ctrl::PressureApp app(bus, clock, config);
        return hydro::process::RunApp(bus, clock, app);
      });
}
