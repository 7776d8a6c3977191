// A loop with a fixed period on absolute deadlines that handles messages while it waits.
#pragma once

#include <chrono>
#include <cstdint>

#include "bus/bus.h"
#include "bus/clock.h"
#include "process/timing/loop_statistics.h"

namespace hydro::timing {

// Tick 0 is the moment of construction. Tick k is due k periods later whatever happens in between, so the
// loop never drifts. On a simulated clock every tick comes exactly when it is due.
class FixedRateLoop {
 public:
  // `period` need not be a whole number of ns. Wake-ups are recorded in `statistics`: the latency of a cycle
  // is the time from its deadline to the wake-up. On a wall clock the loop lowers the thread's timer slack,
  // which would otherwise make every wake-up 50 us late. Throws std::invalid_argument when the period is not
  // positive. After `last_tick`, when it is not negative, nothing is due: late wake-ups skip no tick beyond
  // it.
  FixedRateLoop(bus::Bus& bus, const bus::Clock& clock, std::chrono::duration<double, std::nano> period,
                LoopStatistics& statistics, int64_t last_tick = -1);

  // Handles messages until the next tick is due (waiting messages are handled even when the tick is due
  // already). Returns how many ticks have become due since the last return: 1, or more when some were skipped
  // because the loop was late. Returns 0 when a signal arrived first; the next call goes on waiting for the
  // same tick.
  int64_t Wait();

  bus::Clock::TimePoint woke() const { return woke_; }  // when the last tick, or the loop, began
  int64_t tick() const { return tick_; }                // the newest tick that was due
  int64_t skipped() const { return skipped_; }          // ticks for which Wait() did not return
  bus::Clock::Duration late() const { return late_; }   // how long after that tick was due

 private:
  bus::Clock::TimePoint DueTime(int64_t tick) const;

  bus::Bus& bus_;
  const bus::Clock& clock_;
  double period_ns_;
  LoopStatistics& statistics_;
  int64_t last_tick_;
  bus::Clock::TimePoint start_;
  bus::Clock::TimePoint woke_;
  int64_t tick_ = 0;
  int64_t skipped_ = 0;
  bus::Clock::Duration late_{};
};

}  // namespace hydro::timing
