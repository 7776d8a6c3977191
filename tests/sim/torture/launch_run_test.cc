// Whole runs in which the launcher's own code starts, watches and stops the stack.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "sim/torture/message_tail.h"
#include "sim/torture/run_schedule.h"

namespace hydro::torture {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kPlant = 0, kPosition = 2, kLogger = 3, kLauncher = 5;

// A run with these faults, every line of it. Nothing is violated.
std::string LinesOf(const std::vector<Injection>& injections, bool logger = false,
                    bool logger_required = true) {
  Schedule schedule;
  schedule.launcher = true;
  schedule.logger = logger;
  schedule.logger_required = logger_required;
  schedule.faults_until_s = 1;
  for (const Injection& injection : injections) {
    schedule.faults_until_s = std::max(schedule.faults_until_s, injection.at_s + injection.duration_s);
  }
  schedule.injections = injections;
  MessageTail tail(1e9);
  const RunOutcome outcome = RunSchedule(schedule, "", &tail);
  for (const Violation& violation : outcome.violations)
    ADD_FAILURE() << violation.invariant << ": " << violation.text;
  return tail.Text();
}

int Count(const std::string& text, const std::string& part) {
  int count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// Tests that the launcher asks who is there, starts three processes, finds them ready, and ends with 0 after
// a stop.
TEST(LaunchRunTest, InOrder) {
  const std::string lines = LinesOf({});
  EXPECT_THAT(lines, HasSubstr("asks who is there"));
  EXPECT_EQ(Count(lines, "says: all 3 processes ready"), 1);
  EXPECT_THAT(lines, HasSubstr("says: stopped by launch: hydro-launch --stop"));
  EXPECT_THAT(lines, HasSubstr("launcher 0: ends with exit code 0"));
  EXPECT_THAT(lines, Not(HasSubstr("complains")));
}

// Tests that a child's death ends the launch with 1, and that the operator starts another.
TEST(LaunchRunTest, ChildDies) {
  const std::string lines = LinesOf({{2, FaultKind::kCrash, kPosition, 0, 0, 1}});
  EXPECT_THAT(lines, HasSubstr("complains: hydro-position-ctrl was killed by signal 9 (SIGKILL)"));
  EXPECT_THAT(lines, HasSubstr("launcher 0: ends with exit code 1"));
  EXPECT_EQ(Count(lines, "says: all 3 processes ready"), 2);
}

// Tests that the end of a logger that is not required ends nothing; of one that is, the launch.
TEST(LaunchRunTest, LoggerDies) {
  const std::vector<Injection> crash{{2, FaultKind::kCrash, kLogger, 0, 0, 1}};
  EXPECT_EQ(Count(LinesOf(crash, true, true), "says: all 4 processes ready"), 2);
  const std::string optional = LinesOf(crash, true, false);
  EXPECT_EQ(Count(optional, "says: all 4 processes ready"), 1);
  EXPECT_THAT(optional, HasSubstr("the run goes on (logger.required = false)"));
}

// Tests that the death of the launcher ends its children by SIGTERM.
TEST(LaunchRunTest, LauncherDies) {
  const std::string lines = LinesOf({{2, FaultKind::kLauncherCrash, kLauncher, 0, 0, 1}});
  EXPECT_THAT(lines, HasSubstr("plant 1: is sent signal 15"));
  EXPECT_THAT(lines, HasSubstr("plant 1: ends with exit code 0"));
  EXPECT_EQ(Count(lines, "says: all 3 processes ready"), 2);
}

// Tests that a launcher that hangs sends no heartbeats.
TEST(LaunchRunTest, LauncherHangs) {
  const std::string lines = LinesOf({{2, FaultKind::kLauncherHang, kPlant, 1.5, 0, 1}});
  EXPECT_THAT(lines, HasSubstr("supervisor_gone"));
  EXPECT_EQ(Count(lines, "says: all 3 processes ready"), 1);
}

// Tests that one SIGINT waits for a child that hangs until its time is over, and that a second does not.
TEST(LaunchRunTest, Interrupted) {
  const Injection hang{2, FaultKind::kLongHang, kPosition, 6, 0, 1};
  const std::string once = LinesOf({hang, {2.1, FaultKind::kInterrupt, kLauncher, 0.5, 1, 1}});
  EXPECT_THAT(once, HasSubstr("5.100000 position_ctrl 3: is sent signal 9"));
  EXPECT_THAT(once, HasSubstr("complains: hydro-position-ctrl did not end on SIGTERM and was killed"));
  const std::string twice = LinesOf({hang, {2.1, FaultKind::kInterrupt, kLauncher, 0.5, 2, 1}});
  EXPECT_THAT(twice, HasSubstr("complains: second SIGINT: killing what is left"));
  EXPECT_THAT(twice, HasSubstr("2.600000 position_ctrl 3: is sent signal 9"));
}

// Tests that a process that has not begun when it is told to end dies of the signal, as one that catches none
// yet.
TEST(LaunchRunTest, InterruptedAtTheStart) {
  const std::string lines = LinesOf({{0.35, FaultKind::kInterrupt, kLauncher, 0.5, 1, 1}});
  EXPECT_THAT(lines, HasSubstr("says: stopped by SIGINT"));
  EXPECT_THAT(lines, HasSubstr("launcher 0: ends with exit code 0"));
}

}  // namespace
}  // namespace hydro::torture
