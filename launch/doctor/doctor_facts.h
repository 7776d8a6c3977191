// Gathers the facts that the doctor judges from files under /proc and /sys, from limits and from sockets.
// Changes nothing.
#pragma once

#include "launch/doctor/doctor.h"

namespace hydro::launch {

// Takes two seconds, during which it listens on the port and measures wake-ups; up to four when multicast
// packets do not come back.
MachineFacts GatherFacts(const DoctorTask& task);

}  // namespace hydro::launch
