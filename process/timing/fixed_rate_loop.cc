#include "process/timing/fixed_rate_loop.h"

#include <sys/prctl.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hydro::timing {

FixedRateLoop::FixedRateLoop(bus::Bus& bus, const bus::Clock& clock,
                             std::chrono::duration<double, std::nano> period, LoopStatistics& statistics,
                             int64_t last_tick)
    : bus_(bus),
      clock_(clock),
      period_ns_(period.count()),
      statistics_(statistics),
      last_tick_(last_tick),
      start_(clock.Now()),
      woke_(start_) {
  if (!(period_ns_ >= 1)) throw std::invalid_argument("the period of a loop must be at least 1 ns");
  if (!clock_.simulated()) prctl(PR_SET_TIMERSLACK, 1);
}

bus::Clock::TimePoint FixedRateLoop::DueTime(int64_t tick) const {
  return start_ + std::chrono::nanoseconds(std::llround(static_cast<double>(tick) * period_ns_));
}

int64_t FixedRateLoop::Wait() {
  const bus::Clock::TimePoint due = DueTime(tick_ + 1);
  bus::Clock::TimePoint now;
  do {
    const int handled = bus_.HandleUntil(due);
    if (handled > 0) statistics_.RecordQueueDepth(handled);
    now = clock_.Now();
    if (handled == 0 && now < due) return 0;
  } while (now < due);

  const double late_ns = std::chrono::duration<double, std::nano>(now - due).count();
  int64_t elapsed = 1 + static_cast<int64_t>(late_ns / period_ns_);
  // The quotient may be off by one, because due times are rounded.
  while (DueTime(tick_ + elapsed) > now) --elapsed;
  while (DueTime(tick_ + elapsed + 1) <= now) ++elapsed;

  if (last_tick_ > tick_) elapsed = std::min(elapsed, last_tick_ - tick_);
  tick_ += elapsed;
  skipped_ += elapsed - 1;
  statistics_.AddMissedDeadlines(elapsed - 1);
  woke_ = now;
  late_ = now - due;
  statistics_.RecordCycle(woke_, late_);
  return elapsed;
}

}  // namespace hydro::timing
