// hydro-driver --check-sensors: shows what the sensors read, and drives nothing.
#pragma once

#include <string>

#include "bus/clock.h"
#include "plant/driver/board_sensors.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// Opens the board and prints a table of all signals to stdout twice a second, until time.duration_s has
// passed or a stop signal was caught. Nothing is written to the board, not even a zero. Returns the exit
// code: 0, or 1 when a sensor was at fault in the last table. Throws InputError and RigError as BoardSensors.
int CheckSensors(const settings::StackConfig& config, const bus::Clock& clock);

// One line of that table: signal, where it comes from, the board's code, the volts, the signal and its unit,
// and a word where it is at fault.
std::string DescribeReading(const BoardSensor& sensor, double value);

}  // namespace hydro::plant
