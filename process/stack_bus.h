// Opens the bus of a configuration.
#pragma once

#include <memory>

#include "bus/udpm/udpm_bus.h"
#include "settings/stack_config.h"

namespace hydro::process {

// Opens the bus with the configuration's key, if it has one. Throws InputError for a bad URL or key file, and
// BusError with the cure when multicast does not work.
std::unique_ptr<bus::UdpmBus> OpenStackBus(const settings::BusSection& section);

}  // namespace hydro::process
