#include "process/timing/followed_rate_loop.h"

#include <sys/prctl.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hydro::timing {
namespace {

constexpr double kGrace = 0.5;  // periods by which a sample may be late
// kGain is the share of a sample's deviation by which the expected time of the next sample is corrected;
// kMost bounds that correction. Quartz clocks differ by far less than kMost, and a device whose clock is
// wrong by more is not followed.
constexpr double kGain = 0.125, kMost = 0.005;  // periods

}  // namespace

FollowedRateLoop::FollowedRateLoop(const bus::Clock& clock, std::chrono::duration<double, std::nano> period,
                                   LoopStatistics& statistics, int64_t last_tick)
    : period_ns_(period.count()),
      statistics_(statistics),
      last_tick_(last_tick),
      start_(clock.Now()),
      woke_(start_) {
  if (!(period_ns_ >= 1)) throw std::invalid_argument("the period of a loop must be at least 1 ns");
  if (!clock.simulated()) prctl(PR_SET_TIMERSLACK, 1);
}

FollowedRateLoop::TimePoint FollowedRateLoop::deadline() const {
  return start_ + std::chrono::nanoseconds(std::llround(since_start_ns_ + (1 + kGrace) * period_ns_));
}

// The device's count is right when it agrees with the time that has passed here. When a device has restarted,
// or its clock is far wrong, this computer's clock counts the ticks.
int64_t FollowedRateLoop::Count(double periods, std::optional<int64_t> arrived) {
  if (!arrived) {
    const auto due = static_cast<int64_t>(std::floor(periods - kGrace + 1e-6));
    if (due > 0 && number_) *number_ += due;
    return std::max<int64_t>(due, 0);
  }
  const auto by_device = number_ ? static_cast<double>(*arrived) - static_cast<double>(*number_) : NAN;
  const bool agrees = std::fabs(by_device - periods) <= 1 + 0.25 * std::fabs(periods);
  const double due = agrees ? by_device : std::round(periods);
  if (due > 0 || !agrees) number_ = arrived;
  return static_cast<int64_t>(std::max(due, 0.0));
}

int64_t FollowedRateLoop::Elapsed(TimePoint now, std::optional<int64_t> arrived) {
  const double since_start_ns = std::chrono::duration<double, std::nano>(now - start_).count();
  const bool first = arrived && !number_;
  int64_t elapsed = Count((since_start_ns - since_start_ns_) / period_ns_, arrived);
  if (last_tick_ > tick_) elapsed = std::min(elapsed, last_tick_ - tick_);
  const double expected_ns = since_start_ns_ + static_cast<double>(elapsed) * period_ns_;
  const double late_ns = since_start_ns - expected_ns;
  if (first) since_start_ns_ = since_start_ns;
  if (elapsed == 0) return 0;
  if (!first) since_start_ns_ = expected_ns;
  if (arrived && !first)
    since_start_ns_ += std::clamp(kGain * late_ns, -kMost * period_ns_, kMost * period_ns_);

  tick_ += elapsed;
  skipped_ += elapsed - 1;
  statistics_.AddMissedDeadlines(elapsed - 1);
  woke_ = now;
  late_ = std::chrono::nanoseconds(std::llround(std::max(late_ns, 0.0)));
  statistics_.RecordCycle(woke_, late_);
  return elapsed;
}

}  // namespace hydro::timing
