#include "launch/doctor/wake_ups.h"

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace hydro::launch {

// A wake-up that is late by whole periods misses the ticks in between (process/timing/fixed_rate_loop.h).
WakeUps CountWakeUps(double rate_hz, double duration_s, const std::function<double(double)>& sleep_until) {
  WakeUps counted;
  const auto last = static_cast<int64_t>(std::floor(duration_s * rate_hz + 1e-6));
  while (counted.ticks < last) {
    const double due = static_cast<double>(counted.ticks + 1) / rate_hz;
    const double woke = sleep_until(due);
    counted.latest_s = std::max(counted.latest_s, woke - due);
    const auto newest = static_cast<int64_t>(std::floor(woke * rate_hz + 1e-6));
    const int64_t reached = std::clamp<int64_t>(newest, counted.ticks + 1, last);
    counted.skipped += reached - counted.ticks - 1;
    counted.ticks = reached;
  }
  return counted;
}

WakeUps MeasureWakeUps(double rate_hz, double duration_s, int priority, int cpu) {
  WakeUps measured;
  std::thread thread([&] {
    prctl(PR_SET_TIMERSLACK, 1);
    if (cpu >= 0 && cpu < CPU_SETSIZE) {
      cpu_set_t one;
      CPU_ZERO(&one);
      CPU_SET(static_cast<size_t>(cpu), &one);
      pthread_setaffinity_np(pthread_self(), sizeof one, &one);
    }
    if (priority > 0) {
      const sched_param fifo{.sched_priority = priority};
      pthread_setschedparam(pthread_self(), SCHED_FIFO, &fifo);
    }
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    measured = CountWakeUps(rate_hz, duration_s, [&](double due) {
      std::this_thread::sleep_until(
          start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(due)));
      return std::chrono::duration<double>(Clock::now() - start).count();
    });
  });
  thread.join();
  return measured;
}

}  // namespace hydro::launch
