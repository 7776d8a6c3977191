// Time as an application sees it, for deadlines, watchdogs and statistics only. Control laws and the model
// never see a clock.
#pragma once

#include <time.h>

#include <chrono>
#include <cstdint>
#include <ctime>

namespace hydro::bus {

class Clock {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  virtual ~Clock() = default;

  // Monotonic time, for deadlines and intervals.
  TimePoint Now() const { return stands_ ? now_ : Read(); }

  // Microseconds since 1970-01-01 UTC, for the utime field of messages.
  virtual int64_t Utime() const = 0;

  // How long the machine has been suspended since boot. Now() does not count that time.
  virtual Duration Suspended() const { return {}; }

  // Suspended(), or more by the time that has passed since Now() was `now`. It saves one reading of a clock.
  virtual Duration SuspendedAtMost(TimePoint /*now*/) const { return Suspended(); }

  // True when time passes only because a caller that waits advances the clock.
  virtual bool simulated() const { return false; }

  // On a simulated clock, the session of all processes that run on it (bus/session.h).
  virtual int64_t session() const { return 0; }

 protected:
  // A clock that goes by itself.
  Clock() = default;
  // A clock that stands still, at `now`, until it is set: loops read it without a virtual call.
  explicit Clock(TimePoint now) : stands_(true), now_(now) {}
  void SetTo(TimePoint now) { now_ = now; }

 private:
  // The time that Now() returns on a clock that goes by itself.
  virtual TimePoint Read() const { return now_; }

  bool stands_ = false;
  TimePoint now_{};
};

inline Clock::Duration FromSeconds(double seconds) {
  return std::chrono::duration_cast<Clock::Duration>(std::chrono::duration<double>(seconds));
}
inline double ToSeconds(Clock::Duration duration) { return std::chrono::duration<double>(duration).count(); }

class WallClock : public Clock {
 public:
  int64_t Utime() const override {
    using namespace std::chrono;
    return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
  }
  Duration Suspended() const override { return Since(CLOCK_BOOTTIME) - Since(CLOCK_MONOTONIC); }
  Duration SuspendedAtMost(TimePoint now) const override {
    return Since(CLOCK_BOOTTIME) - now.time_since_epoch();
  }

 private:
  TimePoint Read() const override { return std::chrono::steady_clock::now(); }
  static Duration Since(clockid_t id) {
    timespec time{};
    clock_gettime(id, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  }
};

// A clock that starts at 0 and stands still until it is advanced.
class SimulatedClock : public Clock {
 public:
  explicit SimulatedClock(int64_t session = 0) : Clock(TimePoint()), session_(session) {}
  int64_t Utime() const override {
    return std::chrono::duration_cast<std::chrono::microseconds>(Now().time_since_epoch()).count();
  }
  bool simulated() const override { return true; }
  int64_t session() const override { return session_; }

  // Moves to `time`; a time in the past leaves the clock where it is.
  void AdvanceTo(TimePoint time) {
    if (time > Now()) SetTo(time);
  }

 private:
  int64_t session_;
};

// Waits on a bus on which no other process can send. Returns true when the time has come, false when a signal
// came first.
inline bool SleepUntil(std::chrono::steady_clock::time_point time) {
  const auto since = std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
  if (since <= 0) return true;
  timespec until{};
  until.tv_sec = since / 1'000'000'000;
  until.tv_nsec = since % 1'000'000'000;
  return clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == 0;
}

}  // namespace hydro::bus
