// A state to the pressure loop and its command back, between two processes: the stack beside bare LCM and
// other middleware that exchange as many bytes, alternating in the same run.
//   bench_round_trip [ROUNDS]
#include <sched.h>
#include <sys/mman.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/child_process.h"
#include "bench/echo_peers.h"
#include "bus/seal/authenticator.h"
#include "bus/udpm/open_udpm_bus.h"
#include "pressure_ctrl/pressure_app.h"
#include "process/timing/histogram.h"
#include "tests/free_udp_port.h"

namespace hydro {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

constexpr int kBlocks = 20;
constexpr int kTripsPerBlock = 100;

std::unique_ptr<bus::Authenticator> KeyedOrNot(bool with_key) {
  if (!with_key) return nullptr;
  return std::make_unique<bus::Authenticator>(bus::BusKey({1, 2, 3}),
                                              bus::AuthenticatedChannels(bus::Channels()));
}

// The plant's end of the bus; waits as the plant does.
class StackPinger : public Pinger {
 public:
  StackPinger(const std::string& url, bool with_key)
      : opened_(bus::OpenUdpmBus(url, KeyedOrNot(with_key))),
        states_(bus_.Advertise<state_t>("HYDRO_STATE")) {
    bus_.Subscribe<motor_command_t>("HYDRO_MOTOR_COMMAND",
                                    [this](const motor_command_t& command) { answered_ = command.tick; });
  }
  bool Trip(int64_t number) override {
    state_t state{};
    state.tick = number;
    state.session = 1;
    state.sequence = sequence_++;
    states_.Send(state);
    const auto deadline = SteadyClock::now() + 1s;
    while (answered_ != number) {
      if (bus_.HandleUntil(deadline) == 0) return false;
    }
    return true;
  }

 private:
  std::unique_ptr<bus::UdpmBus> opened_;
  bus::UdpmBus& bus_ = *opened_;
  bus::Publisher<state_t> states_;
  int64_t answered_ = -1;
  int64_t sequence_ = 0;
};

// The pressure loop, as hydro-pressure-ctrl runs it.
void AnswerOnBus(const std::string& url, bool with_key) {
  const settings::StackConfig config =
      settings::LoadStackConfig(HYDRO_BENCH_CONFIG, {"time.mode=realtime", "limits.stale_input_s=1e6"});
  const auto opened = bus::OpenUdpmBus(url, KeyedOrNot(with_key));
  bus::UdpmBus& bus = *opened;
  bus::WallClock clock;
  pressure_ctrl::PressureApp app(bus, clock, config);
  process::RunApp(bus, clock, app);
}

Peer StackPeer(const std::string& name, bool with_key = false) {
  const std::string url = FreeBusUrl();
  return {name, [=] { AnswerOnBus(url, with_key); },
          [=] { return std::make_unique<StackPinger>(url, with_key); }};
}

enum class Placement { kAnywhere, kOneCore, kTwoCores };

void Pin(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<unsigned>(cpu), &set);
  sched_setaffinity(0, sizeof set, &set);
}

std::vector<int> Cpus(const cpu_set_t& set) {
  std::vector<int> cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(static_cast<unsigned>(cpu), &set)) cpus.push_back(cpu);
  }
  return cpus;
}

std::vector<Peer> Everyone() {
  std::vector<Peer> peers = MakePeers();
  peers.insert(peers.begin() + 1, StackPeer("stack"));
  peers.insert(peers.begin() + 2, StackPeer("stack with a key", true));
  return peers;
}

// One round with fresh processes. Which core the kernel gives to which thread makes a difference of a third
// and stays for the life of a process.
void RunRound(Placement placement, const std::vector<int>& cpus, std::span<timing::Histogram> times) {
  std::vector<Peer> peers = Everyone();
  std::vector<std::unique_ptr<ChildProcess>> echoes;
  if (placement != Placement::kAnywhere) Pin(cpus.front());
  // Start all children first: a process must not fork once it runs threads.
  for (const Peer& peer : peers) {
    echoes.push_back(std::make_unique<ChildProcess>([&] {
      if (placement == Placement::kTwoCores) Pin(cpus.back());
      peer.echo();
    }));
  }
  std::vector<std::unique_ptr<Pinger>> pingers;
  for (const Peer& peer : peers) {
    pingers.push_back(peer.make_pinger());
    bool answered = false;
    for (int i = 0; i < 20 && !answered; ++i) answered = pingers.back()->Trip(1'000'000'000 + i);
    if (!answered) throw std::runtime_error(peer.name + " does not answer");
  }
  int64_t number = 0;
  for (int block = 0; block < kBlocks; ++block) {
    for (size_t i = 0; i < peers.size(); ++i) {
      for (int trip = 0; trip < kTripsPerBlock; ++trip) {
        const auto start = SteadyClock::now();
        if (pingers[i]->Trip(number++)) {
          times[i].Record(std::chrono::nanoseconds(SteadyClock::now() - start).count());
        }
      }
    }
  }
}

void Measure(Placement placement, const std::string& title, int rounds) {
  cpu_set_t permitted;
  sched_getaffinity(0, sizeof permitted, &permitted);
  const std::vector<int> cpus = Cpus(permitted);
  if (placement == Placement::kTwoCores && cpus.size() < 2) return;
  const std::vector<Peer> peers = Everyone();
  void* const memory = mmap(nullptr, peers.size() * sizeof(timing::Histogram), PROT_READ | PROT_WRITE,
                            MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  const std::span<timing::Histogram> times(new (memory) timing::Histogram[peers.size()], peers.size());
  for (int round = 0; round < rounds; ++round) {
    // This too runs in its own process: some of these libraries cannot be used on both sides of a fork.
    const pid_t runner = fork();
    if (runner == 0) {
      try {
        RunRound(placement, cpus, times);
      } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        _exit(1);
      }
      _exit(0);
    }
    int status = 0;
    waitpid(runner, &status, 0);
    if (status != 0) throw std::runtime_error("a round failed");
  }
  std::printf("\n%-28s %8s %8s %8s %10s %8s %8s\n", title.c_str(), "p50 us", "p99 us", "p99.9 us", "count",
              "p50 : LCM", "p99 : LCM");
  const auto us = [](int64_t ns) { return 1e-3 * static_cast<double>(ns); };
  for (size_t i = 0; i < peers.size(); ++i) {
    const double p50 = us(times[i].Percentile(50)), p99 = us(times[i].Percentile(99));
    std::printf("%-28s %8.1f %8.1f %8.1f %10lld %8.2f %8.2f\n", peers[i].name.c_str(), p50, p99,
                us(times[i].Percentile(99.9)), static_cast<long long>(times[i].Count()),
                p50 / us(times[0].Percentile(50)), p99 / us(times[0].Percentile(99)));
  }
  std::fflush(stdout);
}

}  // namespace

std::vector<Peer> MakePeers() {
  std::vector<Peer> peers{LcmPeer()};
#ifdef HYDRO_BENCH_CYCLONE
  peers.push_back(CyclonePeer());
#endif
#ifdef HYDRO_BENCH_ZEROMQ
  peers.push_back(ZeroMqPeer());
#endif
#ifdef HYDRO_BENCH_NNG
  peers.push_back(NngPeer());
#endif
  return peers;
}

}  // namespace hydro

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 5;
  if (rounds <= 0 || argc > 2) {
    std::fprintf(stderr, "usage: bench_round_trip [ROUNDS]; ROUNDS must be positive\n");
    return 2;
  }
  // Keep the peers' traffic on this machine, as the stack's is.
  setenv("CYCLONEDDS_URI",
         "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\" "
         "multicast=\"true\"/></Interfaces>"
         "</General></Domain></CycloneDDS>",
         0);
  try {
    hydro::Measure(hydro::Placement::kOneCore, "both on one core", rounds);
    hydro::Measure(hydro::Placement::kTwoCores, "each on a core of its own", rounds);
    hydro::Measure(hydro::Placement::kAnywhere, "wherever the kernel likes", rounds);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
