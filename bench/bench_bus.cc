// What the bus costs: the round trip of a state to the pressure loop's command between two processes over UDP
// multicast, beside a bare LCM echo of the same messages in the same run, and the time per message within one
// process.
#include <benchmark/benchmark.h>
#include <sched.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <hydro/motor_command_t.hpp>
#include <hydro/state_t.hpp>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>
#include <vector>

#include "bench/child_process.h"
#include "bus/authenticated_channels.h"
#include "bus/histogram.h"
#include "bus/in_process_bus.h"
#include "bus/udpm_bus.h"
#include "pressure_ctrl/pressure_app.h"
#include "tests/free_udp_port.h"

namespace hydro {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

const std::string kState = "HYDRO_STATE";
const std::string kCommand = "HYDRO_MOTOR_COMMAND";
constexpr int kRounds = 5;
constexpr int kBlocks = 20;
constexpr int kTripsPerBlock = 100;

// What messages are sealed with where they are; the same in all processes of a round.
std::unique_ptr<Authenticator> KeyedOrNot(bool with_key) {
  if (!with_key) return nullptr;
  return std::make_unique<Authenticator>(BusKey({1, 2, 3}), AuthenticatedChannels(Channels()));
}

// The pressure loop as hydro-pressure-ctrl runs it.
void AnswerOnBus(const std::string& url, bool with_key) {
  StackConfig config =
      LoadStackConfig(HYDRO_BENCH_CONFIG, {"time.mode=realtime", "limits.stale_input_s=1e6"});
  UdpmBus bus(url, KeyedOrNot(with_key));
  WallClock clock;
  PressureApp app(bus, clock, config);
  RunApp(bus, clock, app);
}

class BareEcho {
 public:
  explicit BareEcho(const std::string& url) : lcm_(url) {
    lcm_.subscribe(kState, &BareEcho::OnState, this)->setQueueCapacity(0);
  }
  void Run() {
    while (lcm_.handle() == 0) {
    }
  }

 private:
  void OnState(const lcm::ReceiveBuffer*, const std::string&, const state_t* state) {
    motor_command_t command{};
    command.tick = state->tick;
    lcm_.publish(kCommand, &command);
  }
  lcm::LCM lcm_;
};

class BusPinger {
 public:
  BusPinger(const std::string& url, bool with_key)
      : bus_(url, KeyedOrNot(with_key)), states_(bus_.Advertise<state_t>(kState)) {
    bus_.Subscribe<motor_command_t>(kCommand,
                                    [this](const motor_command_t& command) { answered_ = command.tick; });
  }
  bool Trip(int64_t tick, std::chrono::milliseconds timeout) {
    state_t state{};
    state.tick = tick;
    state.session = 1;
    state.sequence = sequence_++;
    states_.Send(state);
    const auto deadline = SteadyClock::now() + timeout;
    while (answered_ != tick) {
      if (bus_.HandleUntil(deadline) == 0) return false;
    }
    return true;
  }

 private:
  UdpmBus bus_;
  Publisher<state_t> states_;
  int64_t answered_ = -1;
  int64_t sequence_ = 0;
};

class BarePinger {
 public:
  explicit BarePinger(const std::string& url) : lcm_(url) {
    lcm_.subscribe(kCommand, &BarePinger::OnCommand, this)->setQueueCapacity(0);
  }
  bool Trip(int64_t tick, std::chrono::milliseconds timeout) {
    state_t state{};
    state.tick = tick;
    lcm_.publish(kState, &state);
    while (answered_ != tick) {
      if (lcm_.handleTimeout(static_cast<int>(timeout.count())) <= 0) return false;
    }
    return true;
  }

 private:
  void OnCommand(const lcm::ReceiveBuffer*, const std::string&, const motor_command_t* command) {
    answered_ = command->tick;
  }
  lcm::LCM lcm_;
  int64_t answered_ = -1;
};

template <class Pinger>
void RunBlock(Pinger* pinger, int64_t* tick, Histogram* histogram) {
  for (int i = 0; i < kTripsPerBlock; ++i) {
    const auto start = SteadyClock::now();
    const bool answered = pinger->Trip((*tick)++, 1000ms);
    if (answered) histogram->Record(std::chrono::nanoseconds(SteadyClock::now() - start).count());
  }
}

template <class Pinger>
void AwaitEcho(Pinger* pinger) {
  for (int i = 0; i < 100; ++i) {
    if (pinger->Trip(1'000'000'000 + i, 100ms)) return;
  }
  std::fprintf(stderr, "the echo does not answer\n");
  std::exit(1);
}

struct RoundTrips {
  Histogram bare;
  Histogram bus;
  Histogram keyed;  // the bus with messages that are authenticated
};

// One round with fresh processes. Which core the kernel gives to which thread makes a difference of a third
// and stays for the life of a process: hence several rounds.
void RunRound(bool one_core, RoundTrips* times) {
  // The children first: a process must not fork once LCM's threads run in it.
  const std::string bus_url = FreeBusUrl(), bare_url = FreeBusUrl(), keyed_url = FreeBusUrl();
  if (one_core) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<unsigned>(sched_getcpu()), &set);
    sched_setaffinity(0, sizeof set, &set);
  }
  const ChildProcess pressure_loop([&] { AnswerOnBus(bus_url, false); });
  const ChildProcess keyed_loop([&] { AnswerOnBus(keyed_url, true); });
  const ChildProcess bare_echo([&] { BareEcho(bare_url).Run(); });
  BusPinger bus(bus_url, false);
  BusPinger keyed(keyed_url, true);
  BarePinger bare(bare_url);
  AwaitEcho(&bus);
  AwaitEcho(&keyed);
  AwaitEcho(&bare);
  int64_t tick = 0;
  for (int block = 0; block < kBlocks; ++block) {  // alternately, so that both meet the same neighbours
    RunBlock(&bare, &tick, &times->bare);
    RunBlock(&bus, &tick, &times->bus);
    RunBlock(&keyed, &tick, &times->keyed);
  }
}

void PrintRoundTrips(bool one_core) {
  cpu_set_t before;
  sched_getaffinity(0, sizeof before, &before);
  RoundTrips times;
  for (int round = 0; round < kRounds; ++round) RunRound(one_core, &times);
  sched_setaffinity(0, sizeof before, &before);

  std::printf("state to command and back, two processes over UDP multicast%s, us\n%-12s %9s %9s %9s %9s\n",
              one_core ? " on one core" : "", "", "p50", "p99", "p99.9", "trips");
  const auto row = [](const char* name, const Histogram& h) {
    std::printf("%-12s %9.1f %9.1f %9.1f %9lld\n", name, 1e-3 * static_cast<double>(h.Percentile(50)),
                1e-3 * static_cast<double>(h.Percentile(99)), 1e-3 * static_cast<double>(h.Percentile(99.9)),
                static_cast<long long>(h.Count()));
  };
  row("bare LCM", times.bare);
  row("stack", times.bus);
  row("with a key", times.keyed);
  const auto ratios = [](const char* name, const Histogram& a, const Histogram& b) {
    const auto ratio = [&](double percent) {
      return static_cast<double>(a.Percentile(percent)) / static_cast<double>(b.Percentile(percent));
    };
    std::printf("%-12s %9.2f %9.2f %9.2f\n", name, ratio(50), ratio(99), ratio(99.9));
  };
  ratios("stack / bare", times.bus, times.bare);
  ratios("key / none", times.keyed, times.bus);
  std::printf("\n");
}

enum class Sending { kByName, kAdvertised };

// A state and its command: two messages a turn.
void InProcessExchange(benchmark::State& bench, Sending sending, bool tapped) {
  SimulatedClock clock;
  InProcessBus bus(&clock);
  Publisher<state_t> states = bus.Advertise<state_t>(kState);
  Publisher<motor_command_t> commands = bus.Advertise<motor_command_t>(kCommand);
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
  if (tapped) bus.SubscribeAll([&](const RawMessage& message) { bytes += message.size; });
  state_t state{};
  for (auto _ : bench) {
    ++state.tick;
    if (sending == Sending::kAdvertised) {
      states.Send(state);
    } else {
      bus.Publish(kState, state);
    }
    while (answered != state.tick) bus.HandleUntil(Bus::TimePoint::max());
  }
  benchmark::DoNotOptimize(bytes);
  bench.counters["s/message"] = benchmark::Counter(2.0 * static_cast<double>(bench.iterations()),
                                                   benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(InProcessExchange, advertised, Sending::kAdvertised, false);
BENCHMARK_CAPTURE(InProcessExchange, by_name, Sending::kByName, false);
BENCHMARK_CAPTURE(InProcessExchange, advertised_and_tapped, Sending::kAdvertised, true);

// What authentication adds to a message's way: its seal, and the check of it.
void SealAndOpen(benchmark::State& bench) {
  Authenticator authenticator(BusKey({1, 2, 3}), AuthenticatedChannels(Channels()));
  state_t state{};
  std::vector<uint8_t> bytes(static_cast<size_t>(state.getEncodedSize()));
  const int size = state.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  const auto now = SteadyClock::now();
  for (auto _ : bench) {
    const int sealed = authenticator.Seal(kState, &bytes, size);
    const auto opened = authenticator.Open(kState, bytes.data(), sealed, now);
    if (opened.verdict != Authenticator::Verdict::kAccepted) bench.SkipWithError("refused");
  }
}
BENCHMARK(SealAndOpen);

void HistogramRecord(benchmark::State& bench) {
  Histogram histogram;
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

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  try {
    hydro::PrintRoundTrips(false);
    hydro::PrintRoundTrips(true);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
