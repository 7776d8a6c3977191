// Sets real-time scheduling of the calling thread and of the threads that it starts afterwards.
#pragma once

#include <string>
#include <vector>

namespace hydro::timing {

struct RealTimeRequest {
  int priority = 0;          // SCHED_FIFO priority 1..99; 0: leave the scheduling as it is
  int cpu = -1;              // processor to run on, from 0; -1: leave it to the kernel
  bool lock_memory = false;  // keep all memory resident, so that no page fault delays the loop
};

struct RealTimeResult {
  bool priority = false;  // what was asked for and achieved
  bool cpu = false;
  bool memory_locked = false;
  std::vector<std::string> warnings;  // one line for each thing that was refused: what, why, how to permit it
};

// Does what is asked for and nothing else. Logs a warning to stderr for each thing that is refused, and the
// program goes on without it. Call this before opening the bus: threads that start later inherit the
// settings.
RealTimeResult ApplyRealTime(const RealTimeRequest& request);

}  // namespace hydro::timing
