// What the loops of a stack never do once they run: allocate memory, or make a call that may block. Built
// with the optimised programs only (CMakeLists.txt).
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bus/udpm/open_udpm_bus.h"
#include "plant/plant_app.h"
#include "plant/simulated_rig.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "tests/free_udp_port.h"
#include "tests/process/timing/heap_trap.h"
#include "tests/stack_fixture.h"

namespace hydro::timing {
namespace {

using namespace std::chrono_literals;

// Since a loop's first message: after its first report; after another one and a round of histograms.
constexpr auto kBegin = 1200ms, kEnd = 2700ms;

// Runs one application of a stack on a bus of its own and calls `begin` and `end` on its thread, in a
// handler, once when that much time has passed since its first message.
class Loop {
 public:
  Loop(const std::string& url, std::function<void()> begin, std::function<void()> end)
      : opened_(bus::OpenUdpmBus(url)), begin_(std::move(begin)), end_(std::move(end)) {}

  void RunPlant(const settings::StackConfig& config) {
    plant::SimulatedRig rig(config);
    plant::PlantApp plant(bus_, clock_, config, rig);
    bus_.Subscribe<motor_command_t>("HYDRO_MOTOR_COMMAND", [this](const motor_command_t&) { Watch(); });
    plant.Run();
  }
  template <class Application>
  void RunController(const settings::StackConfig& config) {
    Application app(bus_, clock_, config);
    bus_.Subscribe<state_t>("HYDRO_STATE", [this](const state_t&) { Watch(); });
    process::RunApp(bus_, clock_, app);
  }

 private:
  void Watch() {
    const auto now = clock_.Now();
    if (!first_) first_ = now;
    if (!begun_ && now - *first_ > kBegin) {
      begun_ = true;
      begin_();
    } else if (begun_ && !ended_ && now - *first_ > kEnd) {
      ended_ = true;
      end_();
    }
  }

  std::unique_ptr<bus::UdpmBus> opened_;
  bus::UdpmBus& bus_ = *opened_;
  bus::WallClock clock_;
  std::function<void()> begin_, end_;
  std::optional<bus::Clock::TimePoint> first_;
  bool begun_ = false, ended_ = false;
};

constexpr int kLoops = 3;
const char* const kNames[kLoops] = {"plant", "pressure loop", "position loop"};

void RunLoop(int which, const std::string& url, const settings::StackConfig& config,
             std::function<void()> begin, std::function<void()> end) {
  Loop loop(url, std::move(begin), std::move(end));
  if (which == 0) loop.RunPlant(config);
  if (which == 1) loop.RunController<pressure_ctrl::PressureApp>(config);
  if (which == 2) loop.RunController<position_ctrl::PositionApp>(config);
}

class LoopPurityTest : public ::testing::TestWithParam<settings::TimeMode> {
 protected:
  LoopPurityTest() {
    config_.time.mode = GetParam();
    config_.limits.stale_input_s = 3;  // a fault may take memory; none is to come of a busy machine
    // In lockstep a run ends by its ticks: as many as no machine makes in the time that is looked at.
    config_.last_tick = GetParam() == settings::TimeMode::kLockstep ? 4'000'000 : 3500;
  }
  const std::string url_ = FreeBusUrl();
  settings::StackConfig config_ = testing::SmallStack();
};

// Tests that from its second second on no loop takes memory, neither itself nor in a library: over UDP, at
// 1 kHz and in lockstep, reports and histograms included.
TEST_P(LoopPurityTest, TakesNoMemory) {
  if (!kHeapTrapWorks) GTEST_SKIP() << "the sanitizer has the heap";
  std::atomic<int64_t> taken[kLoops];
  std::atomic<int> done = 0;
  for (auto& count : taken) count = -1;
  std::vector<std::thread> threads;
  for (int i = kLoops - 1; i >= 0; --i) {
    threads.emplace_back([&, i] {
      RunLoop(
          i, url_, config_, [] { SetHeapTrap(true); },
          [&, i] {
            taken[i] = ReleaseHeapTrap();
            if (++done == kLoops) {
              const auto bus = bus::OpenUdpmBus(url_);
              stop_t stop{};
              stop.source = "test";
              bus->Publish("HYDRO_STOP", stop);
            }
          });
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < kLoops; ++i) EXPECT_EQ(taken[i], 0) << kNames[i];
}

// Kills the process at any system call but those by which a loop waits for, takes and sends messages.
void AllowOnlyMessages() {
  const auto allow = [](int number, std::vector<sock_filter>* program) {
    program->push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<uint32_t>(number), 0, 1));
    program->push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  };
  std::vector<sock_filter> program{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
  allow(SYS_ppoll, &program);  // waits, until a deadline
  allow(SYS_clock_gettime, &program);
  allow(SYS_exit_group, &program);
  allow(SYS_rt_sigreturn, &program);
  // Taking and sending, never waiting for it: the flags are the third argument.
  for (const int number : {SYS_recvmsg, SYS_sendmsg}) {
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<uint32_t>(number), 0, 4));
    program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[2])));
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, MSG_DONTWAIT, 0, 1));
    program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
    program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP));
  }
  program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP));
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0)
    _exit(77);
}

std::atomic<int>* forbidden;  // shared with the parent: the call that was made; -1: none

void OnForbidden(int, siginfo_t* info, void*) {
  *forbidden = info->si_syscall;
  _exit(98);
}

// Tests that once a loop runs it makes no system call but to wait until its deadline for a message, to take
// one that is there and to send one, both without waiting: nothing that could hold it up.
TEST_P(LoopPurityTest, MakesNoBlockingCall) {
  if (!kHeapTrapWorks) GTEST_SKIP() << "the sanitizer makes calls of its own";
  void* const page = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(page, MAP_FAILED);
  forbidden = new (page) std::atomic<int>(-1);
  for (int watched = 0; watched < kLoops; ++watched) {
    std::vector<pid_t> children;
    for (int i = kLoops - 1; i >= 0; --i) {
      const pid_t child = fork();
      ASSERT_GE(child, 0);
      if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        struct sigaction action = {};
        action.sa_sigaction = OnForbidden;
        action.sa_flags = SA_SIGINFO;
        sigaction(SIGSYS, &action, nullptr);
        if (i == watched) {
          RunLoop(i, url_, config_, AllowOnlyMessages, [] { _exit(0); });
        } else {
          RunLoop(
              i, url_, config_, [] {}, [] {});
        }
        _exit(97);
      }
      children.push_back(child);
    }
    int status = 0;
    const pid_t victim = children[static_cast<size_t>(kLoops - 1 - watched)];
    ASSERT_EQ(waitpid(victim, &status, 0), victim);
    for (const pid_t child : children) {
      if (child == victim) continue;
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    }
    ASSERT_TRUE(WIFEXITED(status)) << kNames[watched] << ": signal " << WTERMSIG(status);
    if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "seccomp is not permitted here";
    EXPECT_EQ(WEXITSTATUS(status), 0) << kNames[watched] << ": system call " << *forbidden;
  }
  munmap(page, 4096);
}

INSTANTIATE_TEST_SUITE_P(Modes, LoopPurityTest,
                         ::testing::Values(settings::TimeMode::kRealtime, settings::TimeMode::kLockstep),
                         [](const auto& param) {
                           return std::string(param.param == settings::TimeMode::kRealtime ? "RealTime"
                                                                                           : "Lockstep");
                         });

// Tests that the trap notices what it is there for.
TEST(HeapTrapTest, Notices) {
  if (!kHeapTrapWorks) GTEST_SKIP() << "the sanitizer has the heap";
  SetHeapTrap();
  int* volatile number = new int(1);
  delete number;
  void* volatile memory = std::malloc(10);
  std::free(memory);
  EXPECT_EQ(ReleaseHeapTrap(), 2);
  SetHeapTrap();
  EXPECT_EQ(ReleaseHeapTrap(), 0);
}

}  // namespace
}  // namespace hydro::timing
