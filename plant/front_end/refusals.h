// Puts into words what a front end says in numbers.
#pragma once

#include <cstdint>
#include <string>

#include "base/input_error.h"
#include "firmware/frames.h"

namespace hydro::plant {

// Names the key of the configuration because of which the device does not take the settings.
InputError RefusalError(const std::string& file, const hydro_settings_held& held);

// Why the device does not take the settings, in its number and in words.
std::string DescribeRefusal(const hydro_settings_held& held);

// What a device says of itself that another one said differently before: "2 analog inputs (8 before)".
std::string DescribeChange(const hydro_identity& before, const hydro_identity& now);

// The bits of enum hydro_fault, one after the other: "pressure limit, watchdog".
std::string DescribeDeviceFaults(uint16_t faults);

// The name of the i-th sensor in the configuration: p1, p2, motor_angle, ...
const char* SensorName(int index);

}  // namespace hydro::plant
