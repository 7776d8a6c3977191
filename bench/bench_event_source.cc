// Sends numbered 128-byte events at a steady rate on an LCM network and prints how many it sent: the load
// that bench/logger_rate has loggers record.
//   bench_event_source URL RATE_HZ SECONDS [CHANNEL]
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "base/input_error.h"
#include "bus/clock.h"
#include "bus/udpm/udpm_socket.h"

int main(int argc, char** argv) {
  const double rate = argc >= 4 ? std::atof(argv[2]) : 0, seconds = argc >= 4 ? std::atof(argv[3]) : 0;
  if (!(rate > 0 && rate <= 1e7 && seconds > 0 && seconds <= 1e4) || argc > 5) {
    std::fprintf(stderr, "usage: bench_event_source URL RATE_HZ SECONDS [CHANNEL], both above 0\n");
    return 2;
  }
  using namespace std::chrono;
  try {
    hydro::bus::UdpmSocket socket(hydro::bus::ParseUdpmUrl(argv[1]));
    const char* const channel = argc == 5 ? argv[4] : "EVENT";
    const auto events = static_cast<int64_t>(rate * seconds);
    std::array<uint8_t, 128> event{};
    const auto start = steady_clock::now();
    for (int64_t i = 0; i < events; ++i) {
      const auto due = start + nanoseconds(static_cast<int64_t>(1e9 * static_cast<double>(i) / rate));
      // When several are due by then, the sleep costs one wake-up, not one each.
      if (due > steady_clock::now() + 50us) hydro::bus::SleepUntil(due);
      std::memcpy(event.data(), &i, sizeof i);
      while (!socket.Send(channel, event.data(), event.size())) std::this_thread::yield();
    }
    const double took = duration<double>(steady_clock::now() - start).count();
    std::printf("%lld events in %.3f s\n", static_cast<long long>(events), took);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
