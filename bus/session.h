// The identity of a process on the bus, so that a restart or a second sender is noticed.
#pragma once

#include <cstdint>

#include "bus/clock.h"

namespace hydro::bus {

// A random number, never 0.
int64_t RandomSession();

// RandomSession() on a wall clock; 0 on a simulated one, where every run is the same to the bit.
int64_t SessionOn(const Clock& clock);

}  // namespace hydro::bus
