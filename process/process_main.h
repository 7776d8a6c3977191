// Code that the processes' main() functions share: bus, real-time setup, errors and exit codes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/clock.h"
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

}  // namespace hydro::process
