// Puts into words what a front end says in numbers.
#pragma once

#include <cstdint>
#include <string>

#include "base/input_error.h"
#include "firmware/frames.h"

namespace hydro::plant {

// Names the key of the configuration because of which the device does not take the settings.
InputError RefusalError(const std::string& file, const hydro_settings_held& held);

// The bits of enum hydro_fault, one after the other: "pressure limit, watchdog".
std::string DescribeDeviceFaults(uint16_t faults);

// The name of the i-th sensor in the configuration: p1, p2, motor_angle, ...
const char* SensorName(int index);

}  // namespace hydro::plant
