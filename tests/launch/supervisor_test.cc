#include "launch/supervisor.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <map>
#include <string>
#include <vector>

namespace hydro::launch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace std::chrono_literals;

// Runs shell scripts under a supervisor; their output goes to a file that is read back.
class SupervisorTest : public ::testing::Test {
 protected:
  SupervisorTest() { Make({}); }
  ~SupervisorTest() override {
    supervisor_.reset();
    close(file_);
  }

  void Make(Grace grace) {
    supervisor_.reset();
    supervisor_ = std::make_unique<Supervisor>(output_, grace);
  }

  pid_t Start(const std::string& label, const std::string& script, bool last = false) {
    return supervisor_->Start({label, {"/bin/sh", "-c", script}, last});
  }

  std::string Text() {
    output_.Flush();
    std::string text(1 << 20, '\0');
    const ssize_t n = pread(file_, text.data(), text.size(), 0);
    text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return text;
  }

  // Waits for a piece of output; false when all children ended without it.
  bool WaitForText(const std::string& part) {
    while (Text().find(part) == std::string::npos) {
      if (supervisor_->finished()) return Text().find(part) != std::string::npos;
      supervisor_->Wait(Supervisor::TimePoint::max());
    }
    return true;
  }

  // Waits for all to end, and returns their labels in that order.
  std::vector<std::string> WaitForAll() {
    std::vector<std::string> order;
    while (!supervisor_->finished()) supervisor_->Wait(Supervisor::TimePoint::max());
    while (const auto ended = supervisor_->NextEnded()) {
      order.push_back(ended->label);
      ended_.emplace(ended->label, *ended);
    }
    return order;
  }

  int file_ = open("/tmp", O_TMPFILE | O_RDWR | O_APPEND | O_CLOEXEC, 0600);
  LabelledOutput output_{file_, file_, false};
  std::unique_ptr<Supervisor> supervisor_;
  std::map<std::string, Ended> ended_;
};

// A script that waits for SIGTERM without a process of its own, says "up" once it can take it, and then
// "bye". (read from a fifo that nobody writes to: the shell itself waits.)
std::string Waiter(const std::string& on_term) {
  return "d=$(mktemp -d); mkfifo $d/f; exec 3<>$d/f; rm -r $d; trap '" + on_term +
         "' TERM; echo up; while :; do read x <&3; done";
}

// Tests that exit codes and signals are told apart.
TEST_F(SupervisorTest, ReportsHowAProcessEnded) {
  Start("five", "exit 5");
  Start("killed", "kill -9 $$");
  WaitForAll();
  EXPECT_EQ(ended_.at("five").end.exit_code, 5);
  EXPECT_EQ(ended_.at("five").end.signal, 0);
  EXPECT_EQ(ended_.at("killed").end.signal, SIGKILL);
  EXPECT_EQ(DescribeEnd("hydro-plant", ended_.at("killed").end),
            "hydro-plant was killed by signal 9 (SIGKILL)");
  EXPECT_EQ(DescribeEnd("hydro-plant", ended_.at("five").end), "hydro-plant ended with exit code 5");
}

// Tests that output is passed on before the end is reported, including an unfinished last line.
TEST_F(SupervisorTest, LastWordsComeBeforeTheEnd) {
  Start("a", "echo out; echo err >&2; printf unfinished");
  while (!supervisor_->NextEnded()) supervisor_->Wait(Supervisor::TimePoint::max());
  const std::string text = Text();
  EXPECT_THAT(text, HasSubstr("[a] out\n"));
  EXPECT_THAT(text, HasSubstr("[a] err\n"));
  EXPECT_THAT(text, HasSubstr("[a] unfinished\n"));
}

// Tests that the end of a program is noticed even if it leaves behind a process that holds the pipe.
TEST_F(SupervisorTest, GrandchildDoesNotHoldTheEnd) {
  Start("a", "sleep 1000 & echo pid $! pid");
  WaitForAll();
  const std::string text = Text();
  const std::size_t at = text.find("pid ") + 4;
  kill(std::stoi(text.substr(at)), SIGKILL);
  EXPECT_EQ(ended_.at("a").end.exit_code, 0);
}

// Tests that processes marked as last get SIGTERM only after all others have ended.
TEST_F(SupervisorTest, StopsTheLastOnesLast) {
  Start("logger", Waiter("echo logger bye; exit 0"), true);
  Start("a", Waiter("echo a bye; exit 0"));
  Start("b", Waiter("echo b bye; exit 0"));
  for (const char* up : {"[a] up", "[b] up", "[logger] up"}) ASSERT_TRUE(WaitForText(up));
  supervisor_->Stop(Supervisor::Clock::now());
  const auto order = WaitForAll();
  ASSERT_EQ(order.size(), 3u);
  EXPECT_EQ(order[2], "logger");
  const std::string text = Text();
  EXPECT_GT(text.find("logger bye"), text.find("a bye"));
  EXPECT_GT(text.find("logger bye"), text.find("b bye"));
  for (const auto& [label, ended] : ended_) {
    EXPECT_TRUE(ended.terminated) << label;
    EXPECT_FALSE(ended.hung) << label;
    EXPECT_EQ(ended.end.exit_code, 0) << label;
  }
}

// Tests that a process that does not end on SIGTERM is killed after its grace period, and that the last ones
// are then stopped.
TEST_F(SupervisorTest, KillsWhatHangs) {
  Make({.child = 50ms, .last = 10s, .before_last = 0s});
  Start("logger", Waiter("exit 0"), true);
  Start("deaf", Waiter(""));
  for (const char* up : {"[deaf] up", "[logger] up"}) ASSERT_TRUE(WaitForText(up));
  supervisor_->Stop(Supervisor::Clock::now());
  EXPECT_THAT(WaitForAll(), ElementsAre("deaf", "logger"));
  EXPECT_TRUE(ended_.at("deaf").hung);
  EXPECT_EQ(ended_.at("deaf").end.signal, SIGKILL);
  EXPECT_FALSE(ended_.at("logger").hung);
}

// Tests that a stop with patience lets processes end by themselves, and signals those that do not.
TEST_F(SupervisorTest, PatienceLetsThemEndThemselves) {
  Start("quick", "exit 0");
  Start("slow", Waiter("exit 3"));
  ASSERT_TRUE(WaitForText("[slow] up"));
  supervisor_->Stop(Supervisor::Clock::now() + 200ms);
  WaitForAll();
  EXPECT_FALSE(ended_.at("quick").terminated);
  EXPECT_TRUE(ended_.at("slow").terminated);
  EXPECT_EQ(ended_.at("slow").end.exit_code, 3);
}

// Tests that KillAll ends everything at once, even deaf and last processes.
TEST_F(SupervisorTest, KillAllKills) {
  Start("logger", Waiter(""), true);
  Start("deaf", Waiter(""));
  for (const char* up : {"[deaf] up", "[logger] up"}) ASSERT_TRUE(WaitForText(up));
  supervisor_->KillAll();
  WaitForAll();
  for (const auto& [label, ended] : ended_) EXPECT_EQ(ended.end.signal, SIGKILL) << label;
}

// Tests that leaving by an exception (the destructor) leaves no child.
TEST_F(SupervisorTest, DestructorEndsChildren) {
  const pid_t pid = Start("a", Waiter("exit 0"));
  ASSERT_TRUE(WaitForText("[a] up"));
  ASSERT_EQ(kill(pid, 0), 0);
  supervisor_.reset();
  EXPECT_EQ(kill(pid, 0), -1);
  EXPECT_EQ(errno, ESRCH);
}

// Tests that signals to us come out of NextSignal() and do not end us.
TEST_F(SupervisorTest, SignalsAreReported) {
  kill(getpid(), SIGINT);
  supervisor_->Wait(Supervisor::TimePoint::max());
  EXPECT_EQ(supervisor_->NextSignal(), SIGINT);
  EXPECT_EQ(supervisor_->NextSignal(), std::nullopt);
}

// Tests that children have a group of their own and can be interrupted though we block signals.
TEST_F(SupervisorTest, ChildrenHaveOwnGroupAndUnblockedSignals) {
  const pid_t pid = Start("a", Waiter("exit 0"));
  ASSERT_TRUE(WaitForText("[a] up"));
  EXPECT_EQ(getpgid(pid), pid);
  kill(pid, SIGTERM);
  WaitForAll();
  EXPECT_EQ(ended_.at("a").end.exit_code, 0);
  EXPECT_FALSE(ended_.at("a").terminated);
}

// Tests that a file that cannot be executed gives an error that names it, and leaves nothing behind.
TEST_F(SupervisorTest, CannotStart) {
  try {
    supervisor_->Start({"a", {"/nonexistent/hydro-plant"}, false});
    FAIL() << "started";
  } catch (const StartError& error) {
    EXPECT_STREQ(error.what(), "/nonexistent/hydro-plant: cannot be started: No such file or directory");
  }
  EXPECT_EQ(supervisor_->running(), 0);
}

// Descriptors of this process that a program started by it would inherit.
int InheritedDescriptors() {
  int count = 0;
  for (int fd = 0; fd < 1024; ++fd) {
    const int flags = fcntl(fd, F_GETFD);
    if (flags >= 0 && (flags & FD_CLOEXEC) == 0) ++count;
  }
  return count;
}

// Tests that a child inherits no descriptor of the supervisor: one that held another's pipe would hide its
// end.
TEST_F(SupervisorTest, ChildrenInheritNoDescriptor) {
  supervisor_.reset();
  const int before = InheritedDescriptors();
  Make({});
  Start("a", Waiter("exit 0"));
  EXPECT_EQ(InheritedDescriptors(), before);
}

}  // namespace
}  // namespace hydro::launch
