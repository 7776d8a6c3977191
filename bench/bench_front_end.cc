// A command to a front end and the first sample that obeys it, over each kind of link, beside a state and its
// command between two of our own processes over UDP multicast, alternating in the same run at the same rates.
//   bench_front_end [SECONDS]
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bench/child_process.h"
#include "bus/udpm/open_udpm_bus.h"
#include "plant/front_end/front_end_rig.h"
#include "pressure_ctrl/pressure_app.h"
#include "process/timing/histogram.h"
#include "tests/free_udp_port.h"

namespace hydro {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

constexpr int kDeviceTicks = 4;  // of the device in one of ours: a sample in each

struct Result {
  timing::Histogram trip_ns;
  int64_t sent = 0;
  int64_t lost = 0;
  double cpu_s = 0;  // of this process, sending and receiving
  int64_t frames = 0;
};

// A port that was free just now; the board binds it.
int UdpPortForAnother() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t length = sizeof address;
  const bool found = bind(fd, reinterpret_cast<sockaddr*>(&address), length) == 0 &&
                     getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length) == 0;
  close(fd);
  if (!found) throw std::runtime_error("no free UDP port");
  return ntohs(address.sin_port);
}

double CpuTime() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Something that answers numbered questions.
class Peer {
 public:
  virtual ~Peer() = default;
  virtual void Ask(int64_t number) = 0;
  // The newest number; waits for something to come, as our processes do, and takes it.
  virtual int64_t Answered(SteadyClock::time_point until) = 0;
  virtual int64_t Frames() const = 0;
  virtual int64_t Lost() const = 0;
};

class FrontEndPeer : public Peer {
 public:
  // `link`: of hydro-front-end.
  FrontEndPeer(const std::string& link, const std::string& url, double rate_hz)
      : config_(Config(url, rate_hz)),
        board_(link, static_cast<int>(kDeviceTicks * rate_hz)),
        rig_(config_, clock_) {
    rig_.Connect();
    rig_.Obey(0);
    for (tick_ = 1; tick_ < 2000 && rig_.connection().sample().state != HYDRO_ARMED; ++tick_) {
      rig_.Read(tick_);
      rig_.Drive(1);
      std::this_thread::sleep_for(1ms);
    }
  }
  void Ask(int64_t number) override {
    rig_.Read(tick_ = base_ + number);
    rig_.Obey(0);
    rig_.Drive(1 + 1e-3 * static_cast<double>(number % 100));
  }
  int64_t Answered(SteadyClock::time_point until) override {
    const auto left = std::max(SteadyClock::duration::zero(), until - SteadyClock::now());
    const timespec most{0, std::chrono::nanoseconds(left).count() % 1000000000};
    pollfd waits{rig_.descriptor(), POLLIN, 0};
    ppoll(&waits, 1, &most, nullptr);
    rig_.Poll();
    return rig_.connection().sample().host_tick - base_;
  }
  int64_t Frames() const override { return rig_.connection().counts().samples + tick_; }
  int64_t Lost() const override {
    const auto& counts = rig_.connection().counts();
    return counts.lost + counts.left_out + counts.device_damaged;
  }

 private:
  class Board {
   public:
    Board(const std::string& link, int rate) : pid_(fork()) {
      if (pid_ == 0) {
        if (std::freopen("/dev/null", "w", stdout) == nullptr) _exit(127);  // the table is ours
        execl(HYDRO_BENCH_BOARD, "hydro-front-end", link.c_str(), "--rate", std::to_string(rate).c_str(),
              nullptr);
        _exit(127);
      }
      std::this_thread::sleep_for(200ms);
    }
    ~Board() {
      kill(pid_, SIGTERM);
      waitpid(pid_, nullptr, 0);
    }

   private:
    pid_t pid_;
  };

  static settings::StackConfig Config(const std::string& url, double rate_hz) {
    return settings::LoadStackConfig(
        HYDRO_BENCH_CONFIG,
        {"driver.url=\"" + url + "\"", "plant.rate_hz=" + std::to_string(rate_hz * kDeviceTicks),
         "position.sample_interval_s=0.1", "driver.watchdog_s=1", "limits.stale_input_s=1",
         "limits.pressure=inf", "limits.motor_speed=inf"});
  }

  static constexpr int64_t base_ = 10000;
  bus::WallClock clock_;
  settings::StackConfig config_;
  Board board_;
  plant::FrontEndRig rig_;
  int64_t tick_ = 0;
};

// Our own two processes.
class StackPeer : public Peer {
 public:
  explicit StackPeer(const std::string& url)
      : opened_(bus::OpenUdpmBus(url)), states_(bus_.Advertise<state_t>("HYDRO_STATE")) {
    bus_.Subscribe<motor_command_t>("HYDRO_MOTOR_COMMAND", [this](const motor_command_t& command) {
      if (command.tick > answered_ + 1 && answered_ >= 0) lost_ += command.tick - answered_ - 1;
      answered_ = command.tick;
      ++received_;
    });
  }
  void Ask(int64_t number) override {
    state_t state{};
    state.tick = number;
    state.session = 1;
    state.sequence = sequence_++;
    states_.Send(state);
  }
  int64_t Answered(SteadyClock::time_point until) override {
    bus_.HandleUntil(until);
    return answered_;
  }
  int64_t Frames() const override { return received_ + sequence_; }
  int64_t Lost() const override { return lost_; }

 private:
  std::unique_ptr<bus::UdpmBus> opened_;
  bus::UdpmBus& bus_ = *opened_;
  bus::Publisher<state_t> states_;
  int64_t answered_ = -1, sequence_ = 0, received_ = 0, lost_ = 0;
};

void AnswerOnBus(const std::string& url) {
  const settings::StackConfig config =
      settings::LoadStackConfig(HYDRO_BENCH_STACK, {"time.mode=realtime", "limits.stale_input_s=1e6"});
  const auto opened = bus::OpenUdpmBus(url);
  bus::UdpmBus& bus = *opened;
  bus::WallClock clock;
  pressure_ctrl::PressureApp app(bus, clock, config);
  process::RunApp(bus, clock, app);
}

// Before a peer's turn: what came while others had theirs is taken, and a device that heard nothing meanwhile
// is armed again.
void Settle(Peer& peer, int64_t* number) {
  constexpr int kEnough = 20, kMost = 5000;
  int answered = 0;
  for (int asked = 0; answered < kEnough; ++asked) {
    if (asked == kMost) throw std::runtime_error("a peer does not answer");
    peer.Ask(++*number);
    std::this_thread::sleep_for(2ms);
    answered = peer.Answered(SteadyClock::now()) >= *number ? answered + 1 : 0;
  }
}

// Asks at this rate, on absolute deadlines; an answer that has not come by the next one counts as none.
void Run(Peer& peer, double rate_hz, double seconds, int64_t* number, Result* result) {
  const auto period =
      std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(1 / rate_hz));
  Settle(peer, number);
  auto next = SteadyClock::now();
  const int64_t frames = peer.Frames(), lost = peer.Lost();
  for (const auto end = next + std::chrono::duration<double>(seconds); next < end; next += period) {
    std::this_thread::sleep_until(next);
    const int64_t asked = ++*number;
    const auto start = SteadyClock::now();
    const double cpu = CpuTime();
    peer.Ask(asked);
    ++result->sent;
    while (SteadyClock::now() < next + period) {
      if (peer.Answered(next + period) < asked) continue;
      result->trip_ns.Record(std::chrono::nanoseconds(SteadyClock::now() - start).count());
      break;
    }
    result->cpu_s += CpuTime() - cpu;
  }
  result->frames += peer.Frames() - frames;
  result->lost += peer.Lost() - lost;
}

void Measure(double rate_hz, double seconds) {
  const std::string folder =
      std::filesystem::temp_directory_path() / ("bench_front_end_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::string url = FreeBusUrl();
  const int port = UdpPortForAnother();
  ChildProcess echo([&] { AnswerOnBus(url); });
  std::vector<std::pair<std::string, std::unique_ptr<Peer>>> peers;
  peers.emplace_back("multicast, two processes", std::make_unique<StackPeer>(url));
  peers.emplace_back("front end, pty", std::make_unique<FrontEndPeer>("pty:" + folder + "/pty",
                                                                      "serial:" + folder + "/pty", rate_hz));
  peers.emplace_back("front end, UDP",
                     std::make_unique<FrontEndPeer>("udp:" + std::to_string(port),
                                                    "udp://127.0.0.1:" + std::to_string(port), rate_hz));
  std::vector<Result> results(peers.size());
  std::vector<int64_t> numbers(peers.size(), 0);
  constexpr int kBlocks = 10;
  for (int block = 0; block < kBlocks; ++block) {
    for (size_t i = 0; i < peers.size(); ++i)
      Run(*peers[i].second, rate_hz, seconds / kBlocks, &numbers[i], &results[i]);
  }
  std::printf("\n%.0f Hz; a front end's answer waits for its next tick, up to %.0f us\n", rate_hz,
              1e6 / (kDeviceTicks * rate_hz));
  std::printf("%-26s %8s %8s %8s %10s %10s %10s %12s\n", "", "p50 us", "p99 us", "max us", "asked",
              "answered", "lost", "cpu us/frame");
  for (size_t i = 0; i < peers.size(); ++i) {
    const Result& r = results[i];
    const auto us = [](int64_t ns) { return 1e-3 * static_cast<double>(ns); };
    std::printf("%-26s %8.1f %8.1f %8.1f %10lld %10lld %10lld %12.2f\n", peers[i].first.c_str(),
                us(r.trip_ns.Percentile(50)), us(r.trip_ns.Percentile(99)), us(r.trip_ns.Percentile(100)),
                static_cast<long long>(r.sent), static_cast<long long>(r.trip_ns.Count()),
                static_cast<long long>(r.lost), 1e6 * r.cpu_s / static_cast<double>(r.frames));
  }
  std::fflush(stdout);  // or the next board, which is forked, says it again
  peers.clear();
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace hydro

int main(int argc, char** argv) {
  spdlog::set_level(spdlog::level::warn);
  try {
    const double seconds = argc > 1 ? std::atof(argv[1]) : 20;
    for (const double rate_hz : {1000.0, 2000.0}) hydro::Measure(rate_hz, seconds);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_front_end: %s\n", error.what());
    return 1;
  }
}
