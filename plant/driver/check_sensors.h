// hydro-driver --check-sensors: shows the sensors' readings and drives nothing.
#pragma once

#include <string>

#include "bus/clock.h"
#include "plant/driver/board_sensors.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// Opens the board and prints a table of all signals to stdout twice a second, until time.duration_s has
// passed or a stop signal was caught. Writes nothing to the board, not even a zero. Returns the exit code: 0,
// or 1 when a sensor was at fault in the last table. Throws InputError and RigError like BoardSensors.
int CheckSensors(const settings::StackConfig& config, const bus::Clock& clock);

// One line of that table: the signal's name, its source, the board's code, the volts, the signal with its
// unit, and the fault if there is one.
std::string DescribeReading(const BoardSensor& sensor, double value, const UnitSystem& units);

}  // namespace hydro::plant
