// The peer of the stack's lockstep: three processes on bare LCM that exchange the same messages in the same
// pattern. A plant sends a state each tick and waits for the fast controller's answer, and on every 25th tick
// for the slow one's.
//   bench_lockstep_peer [TICKS] [one-core]
#include <sched.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <hydro/motor_command_t.hpp>
#include <hydro/pressure_command_t.hpp>
#include <hydro/state_t.hpp>
#include <lcm/lcm-cpp.hpp>
#include <string>

#include "bench/child_process.h"
#include "tests/free_udp_port.h"

namespace hydro {
namespace {

constexpr int kSlowInterval = 25;

template <class Command>
class Echo {
 public:
  Echo(const std::string& url, std::string channel, int interval)
      : lcm_(url), channel_(std::move(channel)), interval_(interval) {
    lcm_.subscribe("STATE", &Echo::OnState, this)->setQueueCapacity(0);
  }
  void Run() {
    while (lcm_.handle() == 0) {
    }
  }

 private:
  void OnState(const lcm::ReceiveBuffer*, const std::string&, const state_t* state) {
    if (state->tick % interval_ != 0) return;
    Command command{};
    command.tick = state->tick;
    lcm_.publish(channel_, &command);
  }

  lcm::LCM lcm_;
  std::string channel_;
  int interval_;
};

class Plant {
 public:
  explicit Plant(const std::string& url) : lcm_(url) {
    lcm_.subscribe("FAST", &Plant::OnFast, this)->setQueueCapacity(0);
    lcm_.subscribe("SLOW", &Plant::OnSlow, this)->setQueueCapacity(0);
  }

  // One tick of lockstep; a state that is not answered is sent again.
  void Step(int64_t tick) {
    state_t state{};
    state.tick = tick;
    lcm_.publish("STATE", &state);
    while (fast_ < tick || (tick % kSlowInterval == 0 && slow_ < tick)) {
      if (lcm_.handleTimeout(100) <= 0) lcm_.publish("STATE", &state);
    }
  }

 private:
  void OnFast(const lcm::ReceiveBuffer*, const std::string&, const motor_command_t* command) {
    fast_ = command->tick;
  }
  void OnSlow(const lcm::ReceiveBuffer*, const std::string&, const pressure_command_t* command) {
    slow_ = command->tick;
  }

  lcm::LCM lcm_;
  int64_t fast_ = -1;
  int64_t slow_ = -1;
};

int Main(int64_t ticks, bool one_core) {
  if (one_core) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<unsigned>(sched_getcpu()), &set);
    sched_setaffinity(0, sizeof set, &set);
  }
  const std::string url = FreeBusUrl();
  const ChildProcess fast([&] { Echo<motor_command_t>(url, "FAST", 1).Run(); });
  const ChildProcess slow([&] { Echo<pressure_command_t>(url, "SLOW", kSlowInterval).Run(); });
  Plant plant(url);
  plant.Step(0);  // returns when both are there
  const auto start = std::chrono::steady_clock::now();
  for (int64_t tick = 1; tick <= ticks; ++tick) plant.Step(tick);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  std::printf("bare LCM lockstep, three processes%s: %.0f ticks/s\n", one_core ? " on one core" : "",
              static_cast<double>(ticks) / elapsed.count());
  return 0;
}

}  // namespace
}  // namespace hydro

int main(int argc, char** argv) {
  const long long ticks = argc > 1 ? std::atoll(argv[1]) : 50'000;
  const bool one_core = argc > 2 && std::strcmp(argv[2], "one-core") == 0;
  if (ticks <= 0 || argc > 3 || (argc > 2 && !one_core)) {
    std::fprintf(stderr, "usage: bench_lockstep_peer [TICKS] [one-core]; TICKS must be positive\n");
    return 2;
  }
  return hydro::Main(ticks, one_core);
}
