// What a launch does when something goes wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/launch/stack_folder.h"

namespace hydro::launch {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Tests that a killed process stops the others, names it and how it ended, and gives exit 1.
TEST(LaunchFailureTest, KilledProcessStopsAll) {
  StackFolder stack;
  stack.Script("pressure_ctrl", "status ready;pid;wait");
  stack.Script("logger", "status ready;wait-term");
  auto launch = stack.Launch({"--log", "a.lcmlog"});
  const std::string line = launch->WaitForLine("] pid ");
  launch->WaitForLine("all 4 processes ready");
  kill(std::stoi(line.substr(line.find("pid ") + 4)), SIGKILL);
  EXPECT_EQ(launch->WaitForExit(), 1);
  EXPECT_THAT(launch->err(),
              Contains("[launch]        hydro-pressure-ctrl was killed by signal 9 (SIGKILL)"));
  EXPECT_THAT(launch->out(), Contains("[logger]        got SIGTERM"));
  EXPECT_THAT(launch->text(), HasSubstr("[plant]         got "));
}

// Tests that the reason is published, so that processes on other hosts, which get no SIGTERM from here, stop
// too.
TEST(LaunchFailureTest, ReasonIsPublished) {
  StackFolder stack;
  stack.Script("plant", "deaf;status ready;wait");  // stands for one that is elsewhere
  stack.Script("position_ctrl", "status ready;await 2;exit 1");
  auto launch = stack.Launch();
  EXPECT_EQ(launch->WaitForExit(), 1);
  EXPECT_THAT(launch->err(), Contains("[launch]        hydro-position-ctrl ended with exit code 1"));
  EXPECT_THAT(launch->out(),
              Contains("[plant]         got stop: hydro-position-ctrl ended with exit code 1"));
}

// Tests that a process's own exit code 2, bad input, is passed on, and that its reason is printed.
TEST(LaunchFailureTest, BadInputOfAChildIsTwo) {
  StackFolder stack;
  stack.Script("position_ctrl", "status failed stack.toml: no such trajectory;exit 2");
  auto launch = stack.Launch();
  EXPECT_EQ(launch->WaitForExit(), 2);
  EXPECT_THAT(launch->err(),
              Contains(HasSubstr("hydro-position-ctrl ended with exit code 2: stack.toml: no such")));
}

// Tests that a failed run that the plant stopped is reported with the plant's reason, once, and gives exit 1.
TEST(LaunchFailureTest, PlantReportsFailure) {
  StackFolder stack;
  stack.Script("plant",
               "status ready;await 2;stop 1 pressure_ctrl has not answered tick 5;status failed x;exit 1");
  stack.Script("pressure_ctrl", "status ready;wait;exit 1");
  auto launch = stack.Launch();
  EXPECT_EQ(launch->WaitForExit(), 1);
  ASSERT_EQ(launch->err().size(), 1u) << launch->text();
  EXPECT_EQ(launch->err()[0], "[launch]        stopped by plant: pressure_ctrl has not answered tick 5");
}

// Tests that a process that does not end on SIGTERM is killed and named, and makes the exit code 1.
TEST(LaunchFailureTest, HangingProcessIsKilled) {
  StackFolder stack;
  stack.Script("position_ctrl", "deaf;status ready;wait-term");
  auto launch = stack.Launch();
  launch->WaitForLine("all 3 processes ready");
  launch->Signal(SIGINT);
  EXPECT_EQ(launch->WaitForExit(), 1);
  EXPECT_THAT(launch->err(),
              Contains("[launch]        hydro-position-ctrl did not end on SIGTERM and was killed"));
}

// Tests that a missing program is one line and exit 2, and that nothing was started.
TEST(LaunchFailureTest, MissingProgram) {
  StackFolder stack({"hydro-plant", "hydro-pressure-ctrl"});
  stack.environment["PATH"] = "/usr/bin:/bin";
  stack.Script("plant", "touch " + stack.file("started") + ";status ready;wait");
  auto launch = stack.Launch();
  EXPECT_EQ(launch->WaitForExit(), 2);
  ASSERT_EQ(launch->err().size(), 1u) << launch->text();
  EXPECT_THAT(launch->err()[0], HasSubstr("hydro-position-ctrl: program not found"));
  EXPECT_FALSE(std::filesystem::exists(stack.file("started")));
}

// Tests that a file that cannot be executed as a program gives exit 2 and stops the rest.
TEST(LaunchFailureTest, ProgramCannotBeExecuted) {
  StackFolder stack({"hydro-plant", "hydro-pressure-ctrl"});
  std::ofstream(stack.file("hydro-position-ctrl")) << "not a program\n";
  std::filesystem::permissions(stack.file("hydro-position-ctrl"), std::filesystem::perms::owner_all);
  auto launch = stack.Launch();
  EXPECT_EQ(launch->WaitForExit(), 2);
  EXPECT_THAT(launch->text(), HasSubstr("hydro-position-ctrl: cannot be started: Exec format error"));
}

// Tests that a bad configuration is one line and exit 2, and that nothing was started.
TEST(LaunchFailureTest, BadConfiguration) {
  StackFolder stack;
  stack.Script("plant", "touch " + stack.file("started") + ";status ready;wait");
  auto launch = stack.Launch({"--set", "plant.rate_hz=-3"});
  EXPECT_EQ(launch->WaitForExit(), 2);
  ASSERT_EQ(launch->err().size(), 1u) << launch->text();
  EXPECT_THAT(launch->err()[0], HasSubstr("rate_hz"));
  EXPECT_THAT(launch->out(), IsEmpty());
  EXPECT_FALSE(std::filesystem::exists(stack.file("started")));
}

// Tests that modes that start nothing refuse options that they would ignore, and that an empty option counts
// as none.
TEST(LaunchFailureTest, OptionsThatWouldBeIgnored) {
  const struct {
    std::vector<std::string> arguments;
    std::string says;
  } usages[] = {
      {{"--stop", "--log", "x"}, "--stop: found --log beside it, allowed are CONFIG and \"--set\""},
      {{"--rearm", "--timing", "x.json"}, "--rearm: found --timing beside it"},
      {{"--stop", "--host", "rig"}, "--stop: found --host beside it"},
      {{"--make-key", "--si"}, "--make-key: found --si beside it"},
      {{"--doctor", "--log", "x"}, "--doctor: found --log beside it"},
      {{"--stop", "--rearm"}, "--stop: found --rearm beside it"},
      {{"--log", ""}, "--log: found \"\", allowed FILE"},
      {{"--timing", ""}, "--timing: found \"\", allowed REPORT.json"},
      {{"--host", ""}, "--host: found \"\", allowed NAME"},
  };
  StackFolder stack;
  stack.Script("plant", "touch " + stack.file("started") + ";status ready;wait");
  for (const auto& usage : usages) {
    auto launch = stack.Launch(usage.arguments);
    EXPECT_EQ(launch->WaitForExit(), 2) << usage.says;
    ASSERT_EQ(launch->err().size(), 1u) << launch->text();
    EXPECT_THAT(launch->err()[0], HasSubstr(usage.says));
    EXPECT_THAT(launch->out(), IsEmpty());
  }
  EXPECT_FALSE(std::filesystem::exists(stack.file("started")));
}

}  // namespace
}  // namespace hydro::launch
