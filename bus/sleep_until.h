// Waits on a bus on which no other process can send.
#pragma once

#include <chrono>
#include <ctime>

namespace hydro::bus {

// Returns true when the time has come, false when a signal came first.
inline bool SleepUntil(std::chrono::steady_clock::time_point time) {
  const auto since = std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
  if (since <= 0) return true;
  timespec until{};
  until.tv_sec = since / 1'000'000'000;
  until.tv_nsec = since % 1'000'000'000;
  return clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == 0;
}

}  // namespace hydro::bus
