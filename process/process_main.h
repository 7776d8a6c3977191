// What the mains of the processes share: options, bus, real-time set-up, errors and exit codes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/clock.h"
#include "settings/command_line.h"
#include "settings/stack_config.h"

namespace hydro::process {

// A process's work, given its bus and configuration; returns the exit code.
using ProcessBody = std::function<int(bus::Bus&, bus::Clock&, const settings::StackConfig&)>;

// Loads the configuration that `options` name, sets up real-time scheduling as the [[process]] entry of
// `program` asks, opens the UDP bus and runs `body`. With --log FILE everything on the bus is recorded too.
// Catches stop signals. Returns the process's exit code; errors are one line on stderr (2: bad input, 1: the
// work failed).
int RunProcess(const std::string& program, const settings::CommonOptions& options, const ProcessBody& body);

}  // namespace hydro::process
