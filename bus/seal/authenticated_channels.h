// Which channels are authenticated when the stack has a key: one table.
#pragma once

#include <string>
#include <vector>

#include "bus/channels.h"

namespace hydro::bus {

// All on which a process acts, and those that make up the record of a run. States too: a controller that
// believes a false state computes an authentic command from it.
inline std::vector<std::string> AuthenticatedChannels(const Channels& channels) {
  return {
      channels.introduction,      // the first
      channels.state,             // what the controllers answer
      channels.motor_command,     // what the plant obeys
      channels.pressure_command,  // what the pressure loop obeys
      channels.stop,              // ends every process
      channels.rearm,             // ends the faults that hold the voltage at zero
      channels.process_status,    // starts a run, ends one in lockstep
      channels.log_progress,      // holds a run in lockstep
      channels.arm_reference,     // the rest is for the record
      channels.run,
      channels.loop_statistics,
      channels.loop_histogram,
      channels.fault,
  };
}

}  // namespace hydro::bus
