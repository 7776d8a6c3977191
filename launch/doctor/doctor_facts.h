// Reads what the doctor judges: files under /proc and /sys, limits, sockets. Changes nothing.
#pragma once

#include "launch/doctor/doctor.h"

namespace hydro::launch {

// Takes two seconds, for which it listens on the port; up to four where multicast does not come back.
MachineFacts GatherFacts(const DoctorTask& task);

}  // namespace hydro::launch
