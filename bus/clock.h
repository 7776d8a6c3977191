// Time as an application sees it, for deadlines, watchdogs and statistics only. Control laws and the model
// never see a clock.
#pragma once

#include <time.h>

#include <chrono>
#include <cstdint>

namespace hydro::bus {

class Clock {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  virtual ~Clock() = default;

  // Monotonic time, for deadlines and intervals.
  virtual TimePoint Now() const = 0;

  // Microseconds since 1970-01-01 UTC, for the utime field of messages.
  virtual int64_t Utime() const = 0;

  // How long the machine has been suspended since boot. Now() does not count that time.
  virtual Duration Suspended() const { return {}; }

  // True when time passes only because a caller that waits advances the clock.
  virtual bool simulated() const { return false; }
};

inline Clock::Duration FromSeconds(double seconds) {
  return std::chrono::duration_cast<Clock::Duration>(std::chrono::duration<double>(seconds));
}
inline double ToSeconds(Clock::Duration duration) { return std::chrono::duration<double>(duration).count(); }

class WallClock : public Clock {
 public:
  TimePoint Now() const override { return std::chrono::steady_clock::now(); }
  int64_t Utime() const override {
    using namespace std::chrono;
    return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
  }
  Duration Suspended() const override { return Since(CLOCK_BOOTTIME) - Since(CLOCK_MONOTONIC); }

 private:
  static Duration Since(clockid_t id) {
    timespec time{};
    clock_gettime(id, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  }
};

// Starts at 0 and stands still until advanced.
class SimulatedClock : public Clock {
 public:
  TimePoint Now() const override { return now_; }
  int64_t Utime() const override {
    return std::chrono::duration_cast<std::chrono::microseconds>(now_.time_since_epoch()).count();
  }
  bool simulated() const override { return true; }

  // Moves to `time`; a time in the past leaves the clock where it is.
  void AdvanceTo(TimePoint time) {
    if (time > now_) now_ = time;
  }

 private:
  TimePoint now_{};
};

}  // namespace hydro::bus
