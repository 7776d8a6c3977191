// A run of hydro-driver on a front end.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/clock.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// Connects, runs, and ends with zero volts. With driver.mode = "loop_on_device" this process is also the stack's pressure loop: it leads
// that of the device. `expected`, `program` and `heartbeat` are those of PlantApp. Returns the process's exit code. Throws InputError like
// FrontEndRig::Connect().
int RunFrontEnd(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
                const std::vector<std::string>& expected, const std::string& program,
                std::function<bool()> heartbeat);

}  // namespace hydro::plant
