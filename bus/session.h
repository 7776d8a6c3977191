// The identity of a process on the bus, by which receivers detect a restart or a second sender.
#pragma once

#include <cstdint>

#include "bus/bus.h"
#include "bus/clock.h"

namespace hydro::bus {

// A random number, never 0.
int64_t RandomSession();

// On a wall clock, RandomSession(). On a simulated clock, that clock's session, so that every run is
// bit-identical.
int64_t SessionOn(const Clock& clock);

// The identity of this process: for a simulated process, the one that the bus holds (Bus::process());
// otherwise the machine's name, the id of this process and SessionOn(clock).
HostedProcess IdentityOn(const Bus& bus, const Clock& clock);

}  // namespace hydro::bus
