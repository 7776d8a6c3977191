// Signals to a launch, its own death, and what it must leave alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>

#include <string>

#include "tests/launch/stack_folder.h"

namespace hydro::launch {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

// Refers to one process, even after its id has been reused.
class Watched {
 public:
  explicit Watched(pid_t pid) : fd_(static_cast<int>(syscall(SYS_pidfd_open, pid, 0))) {
    if (fd_ < 0) throw std::runtime_error("pidfd_open");
  }
  ~Watched() { close(fd_); }
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;
  bool EndsWithin(std::chrono::milliseconds time) const {
    pollfd polled{fd_, POLLIN, 0};
    return poll(&polled, 1, static_cast<int>(time.count())) == 1;
  }

 private:
  int fd_;
};

// The process id that a fake program printed.
pid_t PidOf(LaunchedProgram& launch, const std::string& role) {
  std::string label = "[" + role + "]";
  label.resize(16, ' ');
  const std::string line = launch.WaitForLine(label + "pid ");
  return std::stoi(line.substr(line.find("pid ") + 4));
}

class LaunchSignalTest : public ::testing::TestWithParam<int> {};

// Tests that each of the three signals ends a run in order with exit 0, and that a log that was never begun
// is not recommended.
TEST_P(LaunchSignalTest, EndsInOrder) {
  StackFolder stack;
  auto launch = stack.Launch({"--log", "a.lcmlog"});
  launch->WaitForLine("all 4 processes ready");
  launch->Signal(GetParam());
  EXPECT_EQ(launch->WaitForExit(), 0) << launch->text();
  EXPECT_THAT(launch->out(), Contains(HasSubstr(std::string("stopped by SIG") + sigabbrev_np(GetParam()))));
  EXPECT_THAT(launch->out(), Contains("[logger]        got SIGTERM"));
  EXPECT_THAT(launch->out(),
              Contains(HasSubstr("nothing was recorded: the run ended before a.lcmlog was begun")));
  EXPECT_THAT(launch->out(), Not(Contains(HasSubstr("next: hydro-log summary"))));
  EXPECT_TRUE(launch->err().empty()) << launch->text();
}
INSTANTIATE_TEST_SUITE_P(Signals, LaunchSignalTest, ::testing::Values(SIGINT, SIGTERM, SIGHUP));

// Tests that a second SIGINT ends everything at once, even deaf processes: long before their three seconds
// are over.
TEST(LaunchStopTest, SecondInterruptKills) {
  StackFolder stack;
  stack.Script("plant", "pid;deaf;status ready;wait-term");
  stack.Script("logger", "pid;status ready;wait-term");
  auto launch = stack.Launch({"--log", "a.lcmlog"});
  const Watched plant(PidOf(*launch, "plant"));
  const Watched logger(PidOf(*launch, "logger"));
  launch->WaitForLine("all 4 processes ready");
  launch->Signal(SIGINT);
  launch->WaitForLine("stopped by SIGINT");
  launch->Signal(SIGINT);
  EXPECT_EQ(launch->WaitForExit(), 1);
  EXPECT_THAT(launch->err(), Contains("[launch]        second SIGINT: killing what is left"));
  EXPECT_EQ(launch->text().find("did not end on SIGTERM"), std::string::npos) << launch->text();
  EXPECT_TRUE(plant.EndsWithin(std::chrono::milliseconds(0)));
  EXPECT_TRUE(logger.EndsWithin(std::chrono::milliseconds(0)));
}

// Tests that a killed launch leaves no process after 2 s, and that they end in order though nobody reads
// their output any more.
TEST(LaunchStopTest, KilledLaunchLeavesNoOrphan) {
  StackFolder stack;
  stack.Script("plant", "pid;status ready;wait-term");
  stack.Script("logger",
               "pid;status ready;wait-term;say flushing;complain flushing;touch " + stack.file("flushed"));
  auto launch = stack.Launch({"--log", "a.lcmlog"});
  const Watched plant(PidOf(*launch, "plant"));
  const Watched logger(PidOf(*launch, "logger"));
  launch->WaitForLine("all 4 processes ready");
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  const auto left = [&] {
    return std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
  };
  launch->Signal(SIGKILL);
  EXPECT_TRUE(plant.EndsWithin(left()));
  EXPECT_TRUE(logger.EndsWithin(left()));
  EXPECT_EQ(launch->WaitForExit(), 128 + SIGKILL);
  EXPECT_TRUE(std::filesystem::exists(stack.file("flushed")));
}

// Tests that somebody else's process of the same name survives a failed launch beside it.
TEST(LaunchStopTest, ForeignProcessesAreLeftAlone) {
  StackFolder stack;
  auto environment = stack.environment;
  environment["HYDRO_FAKE_plant"] = "say up;wait-term";
  LaunchedProgram foreign({stack.file("hydro-plant"), stack.config()}, environment);
  foreign.WaitForLine("up");
  const Watched watched(foreign.pid());

  stack.Script("pressure_ctrl", "status ready;exit 1");
  auto launch = stack.Launch();
  EXPECT_EQ(launch->WaitForExit(), 1);
  EXPECT_FALSE(watched.EndsWithin(std::chrono::milliseconds(0)));
  foreign.Signal(SIGTERM);
  EXPECT_EQ(foreign.WaitForExit(), 0);
}

// Tests that a reader that has gone (hydro-launch | head) does not end the stack, which still stops in order.
TEST(LaunchStopTest, LostReaderDoesNotEndTheRun) {
  StackFolder stack;
  stack.Script("plant", "pid;status ready;wait;touch " + stack.file("ended"));
  auto launch = stack.Launch();
  const Watched plant(PidOf(*launch, "plant"));
  launch->WaitForLine("all 3 processes ready");
  launch->CloseOutput();
  launch->Signal(SIGINT);
  EXPECT_EQ(launch->WaitForExit(), 0);
  EXPECT_TRUE(plant.EndsWithin(std::chrono::milliseconds(0)));
  EXPECT_TRUE(std::filesystem::exists(stack.file("ended")));
}

// Tests that a reader that does not read (a stopped terminal) does not delay a stop.
TEST(LaunchStopTest, StuckReaderDoesNotHoldTheStop) {
  StackFolder stack;
  stack.Script("plant", "pid;status ready;print 40000;wait");
  stack.Script("pressure_ctrl", "status ready;wait;touch " + stack.file("stopped"));
  auto launch = stack.Launch();
  const Watched plant(PidOf(*launch, "plant"));
  launch->WaitForLine("plant line 100 ");  // from here on nothing is read
  launch->Signal(SIGINT);
  EXPECT_TRUE(plant.EndsWithin(std::chrono::seconds(20)));
  EXPECT_EQ(launch->WaitForExit() & ~1, 0) << "ends with 0 or, where the plant was stuck in its output, 1";
  EXPECT_TRUE(std::filesystem::exists(stack.file("stopped")));
}

}  // namespace
}  // namespace hydro::launch
