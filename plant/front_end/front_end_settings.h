// Converts the configuration to the settings of a front end.
#pragma once

#include <array>

#include "firmware/frames.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// The settings that the device gets: its wiring, and the limits that it holds on its own. Throws InputError
// when the device that sent `identity` does not suit this configuration by its modes, its ticks, its channels
// or the range of its output.
hydro_settings FrontEndSettings(const settings::StackConfig& config, const hydro_identity& identity);

// The sections of the sensors, in the order in which frames have them.
std::array<const settings::SensorSection*, HYDRO_SENSORS> SensorSections(
    const settings::DriverSection& driver);

}  // namespace hydro::plant
