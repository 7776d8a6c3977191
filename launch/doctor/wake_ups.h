// Measures whether this machine wakes a process in time for a loop, as it is now: with the programs that keep
// it busy.
#pragma once

#include <cstdint>
#include <functional>

namespace hydro::launch {

struct WakeUps {
  int64_t ticks = 0;    // that became due
  int64_t skipped = 0;  // of them, those that a late wake-up missed, as a loop counts them
  double latest_s = 0;  // the latest wake-up, after it was due
};

// Counts over `duration_s`, at a rate. `sleep_until` waits for a time (s after the beginning) and returns the
// time at which it went on. Pure.
WakeUps CountWakeUps(double rate_hz, double duration_s, const std::function<double(double)>& sleep_until);

// The same on this machine, in a thread with this SCHED_FIFO priority (0: none) on this processor (-1: any),
// as far as they are allowed.
WakeUps MeasureWakeUps(double rate_hz, double duration_s, int priority, int cpu);

}  // namespace hydro::launch
