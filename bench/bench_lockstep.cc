// Lockstep over three processes: the stack (plant, pressure loop, position loop) beside bare LCM that
// exchanges the same messages in the same pattern. The fast controller answers each tick's state, the slow
// one every 25th.
//   bench_lockstep [TICKS]
#include <sched.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <hydro/motor_command_t.hpp>
#include <hydro/pressure_command_t.hpp>
#include <hydro/state_t.hpp>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>
#include <vector>

#include "base/maths/spread.h"
#include "bench/child_process.h"
#include "bus/seal/authenticator.h"
#include "bus/udpm/open_udpm_bus.h"
#include "plant/plant_app.h"
#include "plant/simulated_rig.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "settings/stack_config.h"
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

  // One tick of lockstep; sends a state again if it gets no answer.
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

double BareTicksPerSecond(int64_t ticks) {
  const std::string url = FreeBusUrl();
  const ChildProcess fast([&] { Echo<motor_command_t>(url, "FAST", 1).Run(); });
  const ChildProcess slow([&] { Echo<pressure_command_t>(url, "SLOW", kSlowInterval).Run(); });
  Plant plant(url);
  plant.Step(0);  // returns once both controllers are there
  const auto start = std::chrono::steady_clock::now();
  for (int64_t tick = 1; tick <= ticks; ++tick) plant.Step(tick);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  return static_cast<double>(ticks) / elapsed.count();
}

// With a key, all messages are authenticated.
std::unique_ptr<bus::Authenticator> KeyedOrNot(bool with_key) {
  if (!with_key) return nullptr;
  return std::make_unique<bus::Authenticator>(bus::BusKey({1, 2, 3}),
                                              bus::AuthenticatedChannels(bus::Channels()));
}

template <class Controller>
void RunController(const std::string& url, const settings::StackConfig& config, bool with_key) {
  const auto opened = bus::OpenUdpmBus(url, KeyedOrNot(with_key));
  bus::UdpmBus& bus = *opened;
  bus::WallClock clock;
  Controller controller(bus, clock, config);
  process::RunApp(bus, clock, controller);
}

double StackTicksPerSecond(int64_t ticks, const std::string& config_file, bool with_key) {
  const std::string url = FreeBusUrl();
  settings::StackConfig config =
      settings::LoadStackConfig(config_file, {"time.mode=lockstep", "plant.rate_hz=5000"});
  config.last_tick = ticks;
  const ChildProcess fast([&] { RunController<pressure_ctrl::PressureApp>(url, config, with_key); });
  const ChildProcess slow([&] { RunController<position_ctrl::PositionApp>(url, config, with_key); });
  const auto opened = bus::OpenUdpmBus(url, KeyedOrNot(with_key));
  bus::UdpmBus& bus = *opened;
  bus::WallClock clock;
  // The plant's own messages tell when it started and ended.
  int64_t started = 0, ended = 0;
  bus.Subscribe<process_status_t>("HYDRO_PROCESS_STATUS", [&](const process_status_t& status) {
    if (status.role == "plant" && status.state == process_status_t::RUNNING) started = status.utime;
  });
  bus.Subscribe<stop_t>("HYDRO_STOP", [&](const stop_t& stop) { ended = stop.utime; });
  plant::SimulatedRig rig(config);
  plant::PlantApp plant(bus, clock, config, rig);
  if (plant.Run() != 0) {
    std::fprintf(stderr, "bench_lockstep: %s\n", plant.failure().c_str());
    std::exit(1);
  }
  while (ended == 0) bus.HandleUntil(clock.Now() + std::chrono::milliseconds(100));
  return static_cast<double>(ticks) / (1e-6 * static_cast<double>(ended - started));
}

void Compare(int64_t ticks, const std::string& config_file, bool one_core) {
  constexpr int kRounds = 5;
  cpu_set_t before;
  sched_getaffinity(0, sizeof before, &before);
  if (one_core) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<unsigned>(sched_getcpu()), &set);
    sched_setaffinity(0, sizeof set, &set);
  }
  std::vector<double> bare, stack, keyed;
  for (int round = 0; round < kRounds; ++round) {  // alternate, so that both run beside the same other load
    bare.push_back(BareTicksPerSecond(ticks));
    stack.push_back(StackTicksPerSecond(ticks, config_file, false));
    keyed.push_back(StackTicksPerSecond(ticks, config_file, true));
  }
  sched_setaffinity(0, sizeof before, &before);
  std::printf("%-34s %10.0f %10.0f %8.2f %10.0f %8.2f\n",
              one_core ? "three processes on one core" : "three processes", maths::Median(bare),
              maths::Median(stack), maths::Median(stack) / maths::Median(bare), maths::Median(keyed),
              maths::Median(keyed) / maths::Median(stack));
}

}  // namespace
}  // namespace hydro

int main(int argc, char** argv) {
  const long long ticks = argc > 1 ? std::atoll(argv[1]) : 20'000;
  if (ticks <= 0 || argc > 2) {
    std::fprintf(stderr, "usage: bench_lockstep [TICKS]; TICKS must be positive\n");
    return 2;
  }
  try {
    std::printf("%-34s %10s %10s %8s %10s %8s\n", "lockstep, ticks/s (median of 5)", "bare LCM", "stack",
                "ratio", "with key", "to none");
    hydro::Compare(ticks, HYDRO_BENCH_CONFIG, false);
    hydro::Compare(ticks, HYDRO_BENCH_CONFIG, true);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
