// A loop whose pace is set by the clock of a device whose samples arrive over a link.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "bus/clock.h"
#include "process/timing/loop_statistics.h"

namespace hydro::timing {

// A tick begins when the device's next sample has come. The loop does not wait for a sample that does not
// come in time: its tick begins half a period after it was expected, and is not counted again when the sample
// comes after all. So two clocks that differ a little never drift apart, and ticks go on without the device.
// Time is passed in; nothing waits here.
class FollowedRateLoop {
 public:
  using TimePoint = bus::Clock::TimePoint;

  // Tick 0 is at `start`. Wake-ups are recorded in `statistics` as those of a FixedRateLoop are; a tick's
  // deadline is the time at which its sample was expected. Lowers the thread's timer slack on a wall clock.
  // After `last_tick`, when it is not negative, nothing is due.
  FollowedRateLoop(const bus::Clock& clock, std::chrono::duration<double, std::nano> period,
                   LoopStatistics& statistics, int64_t last_tick = -1);

  // The latest time until which to wait for the next sample.
  TimePoint deadline() const;

  // The number of ticks that have become due by `now`; 0: none yet. `arrived` is the device's number of the
  // newest sample, if one has come since the last call.
  int64_t Elapsed(TimePoint now, std::optional<int64_t> arrived);

  TimePoint woke() const { return woke_; }             // when the last tick began
  int64_t skipped() const { return skipped_; }         // ticks that did not begin at a time of their own
  bus::Clock::Duration late() const { return late_; }  // how long after its deadline the last tick began

 private:
  int64_t Count(double periods, std::optional<int64_t> arrived);

  const double period_ns_;
  LoopStatistics& statistics_;
  const int64_t last_tick_;
  double since_start_ns_ = 0;  // when the sample of the last tick was expected
  const TimePoint start_;
  std::optional<int64_t> number_;  // number of the last tick's sample
  TimePoint woke_;
  int64_t tick_ = 0;
  int64_t skipped_ = 0;
  bus::Clock::Duration late_{};
};

}  // namespace hydro::timing
