// hydro-position-ctrl CONFIG: the sampled PD loop, eq. (17).
#include "position_ctrl/position_app.h"
#include "process/process_main.h"

int main(int argc, char** argv) {
  hydro::settings::CommandLine command_line(
      "hydro-position-ctrl",
      "The sampled PD position loop, eq. (17), and the references that it or the pressure loop follows.");
  command_line.AddExamples(
      {"hydro-position-ctrl config/demo.toml        beside a plant; hydro-launch starts all"},
      "docs/launch.md");
  hydro::settings::CommonOptions options;
  command_line.AddCommon(&options);
  if (const auto exit_code = command_line.Parse(argc, argv)) return *exit_code;
  return hydro::process::RunProcess(
      "hydro-position-ctrl", options,
      [](hydro::bus::Bus& bus, hydro::bus::Clock& clock, const hydro::settings::StackConfig& config) {
        hydro::position_ctrl::PositionApp app(bus, clock, config);
        return hydro::process::RunApp(bus, clock, app);
      });
}
