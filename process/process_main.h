// Code that the processes' main() functions share: bus, real-time setup, errors and exit codes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/clock.h"
#include "process/app.h"
#include "settings/command_line.h"
#include "settings/stack_config.h"

namespace hydro::process {

// A process's work. It gets its bus and configuration and returns the exit code.
using ProcessBody = std::function<int(bus::Bus&, bus::Clock&, const settings::StackConfig&)>;

// How a program reads its configuration: with settings::LoadStackConfig, except for a limb.
using ConfigLoader =
    std::function<settings::StackConfig(const std::string& file, const std::vector<std::string>& overrides)>;

// Loads the configuration that `options` names, sets up real-time scheduling as the [[process]] section of
// `program` asks, opens the UDP bus and runs `body`. With --log FILE it also records everything on the bus.
// Catches stop signals. Returns the process's exit code; an error is one line on stderr (2: bad input, 1: the
// work failed).
int RunProcess(const std::string& program, const settings::CommonOptions& options, const ProcessBody& body,
               const ConfigLoader& load = settings::LoadStackConfig);

// main() of a program whose whole work is such an App.
template <class ItsApp>
int AppMain(const std::string& program, const std::string& description, int argc, char** argv) {
  settings::CommandLine command_line(program, description);
  command_line.AddExamples({program + " config/demo.toml        beside a plant; hydro-launch starts all"},
                           "docs/launch.md");
  settings::CommonOptions options;
  command_line.AddCommon(&options);
  if (const auto exit_code = command_line.Parse(argc, argv)) return *exit_code;
  return RunProcess(program, options,
                    [](bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config) {
                      ItsApp app(bus, clock, config);
                      return RunApp(bus, clock, app);
                    });
}

}  // namespace hydro::process
