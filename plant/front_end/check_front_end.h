// hydro-driver --check-sensors with a front end: shows the sensors' readings and drives nothing.
#pragma once

#include "bus/clock.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// Gives the device its settings, does not arm it, and prints a table of all signals to stdout twice a second,
// until time.duration_s has passed or a stop signal was caught. Returns the exit code: 0, or 1 when the last
// table showed a fault of a sensor or the device. Throws InputError and RigError like FrontEndRig.
int CheckFrontEnd(const settings::StackConfig& config, const bus::Clock& clock);

}  // namespace hydro::plant
