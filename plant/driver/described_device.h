// What the author of a driver says of his device, and what the device says of itself: checked, and fit to be
// shown and sent.
#pragma once

#include <string>

#include "plant/driver/device.h"

namespace hydro::plant {

// Device::Describe(), with texts in which nothing moves a cursor or ends a message. Throws InputError that
// names driver.device in `file` when no such device can be.
DeviceDescription Described(const Device& device, const std::string& file);

// Device::Read(), with the same of what the device says of its fault, and no time before the clock's begin.
// Throws RigError: as Device::Read(), or when it gives more or fewer readings than it has inputs.
void ReadDevice(Device& device, const DeviceDescription& description, DeviceReadings& readings);

}  // namespace hydro::plant
