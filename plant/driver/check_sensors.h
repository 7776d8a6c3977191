// A driver's --check-sensors: shows the sensors' readings and drives nothing.
#pragma once

#include <string>

#include "bus/clock.h"
#include "plant/driver/device.h"
#include "plant/driver/device_sensor.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// Prints a table of all signals to stdout twice a second, until time.duration_s has passed or a stop signal
// was caught. The device puts out nothing during that time, not even a zero. Returns the exit code: 0, or 1
// when the last table showed a fault of a sensor or a silent device. Throws InputError and RigError like
// DeviceSensors.
int CheckSensors(const settings::StackConfig& config, const bus::Clock& clock, Device& device);

// One line of that table: the signal's name, its source, the device's own number, the value with its unit,
// the signal with its unit, and the fault if there is one.
std::string DescribeReading(const DeviceSensor& sensor, double value, const UnitSystem& units);

}  // namespace hydro::plant
