// What a message costs within one process: publishing and dispatching it, authenticating it, counting its
// time.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdint>
#include <hydro/motor_command_t.hpp>
#include <hydro/state_t.hpp>
#include <string>
#include <vector>

#include "bus/in_process_bus.h"
#include "bus/seal/authenticator.h"
#include "process/timing/histogram.h"

namespace hydro {
namespace {

const std::string kState = "HYDRO_STATE";
const std::string kCommand = "HYDRO_MOTOR_COMMAND";

enum class Sending { kByName, kAdvertised };

// A state and its command: two messages per turn.
void InProcessExchange(benchmark::State& bench, Sending sending, bool tapped) {
  bus::SimulatedClock clock;
  bus::InProcessBus bus(&clock);
  bus::Publisher<state_t> states = bus.Advertise<state_t>(kState);
  bus::Publisher<motor_command_t> commands = bus.Advertise<motor_command_t>(kCommand);
  motor_command_t command{};
  int64_t answered = -1;
  int64_t bytes = 0;
  bus.Subscribe<state_t>(kState, [&](const state_t& state) {
    command.tick = state.tick;
    if (sending == Sending::kAdvertised) {
      commands.Send(command);
    } else {
      bus.Publish(kCommand, command);
    }
  });
  bus.Subscribe<motor_command_t>(kCommand, [&](const motor_command_t& c) { answered = c.tick; });
  if (tapped) bus.SubscribeAll([&](const bus::RawMessage& message) { bytes += message.size; });
  state_t state{};
  for (auto _ : bench) {
    ++state.tick;
    if (sending == Sending::kAdvertised) {
      states.Send(state);
    } else {
      bus.Publish(kState, state);
    }
    while (answered != state.tick) bus.HandleUntil(bus::Bus::TimePoint::max());
  }
  benchmark::DoNotOptimize(bytes);
  bench.counters["s/message"] = benchmark::Counter(2.0 * static_cast<double>(bench.iterations()),
                                                   benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(InProcessExchange, advertised, Sending::kAdvertised, false);
BENCHMARK_CAPTURE(InProcessExchange, by_name, Sending::kByName, false);
BENCHMARK_CAPTURE(InProcessExchange, advertised_and_tapped, Sending::kAdvertised, true);

// What authentication adds to a message: sealing it and checking the seal.
void SealAndOpen(benchmark::State& bench) {
  bus::Authenticator authenticator(bus::BusKey({1, 2, 3}), bus::AuthenticatedChannels(bus::Channels()));
  state_t state{};
  std::vector<uint8_t> bytes(static_cast<size_t>(state.getEncodedSize()));
  const int size = state.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  const auto now = std::chrono::steady_clock::now();
  for (auto _ : bench) {
    const int sealed = authenticator.Seal(kState, &bytes, size);
    const auto opened = authenticator.Open(kState, bytes.data(), sealed, now);
    if (opened.verdict != bus::Authenticator::Verdict::kAccepted) bench.SkipWithError("refused");
  }
}
BENCHMARK(SealAndOpen);

void HistogramRecord(benchmark::State& bench) {
  timing::Histogram histogram;
  int64_t value = 1;
  for (auto _ : bench) {
    histogram.Record(value);
    value = (value * 6364136223846793005 + 1442695040888963407) & 0xffffff;
  }
  benchmark::DoNotOptimize(histogram);
}
BENCHMARK(HistogramRecord);

}  // namespace
}  // namespace hydro

BENCHMARK_MAIN();
