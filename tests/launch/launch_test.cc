// What a launch does when all goes well, and what it prints.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "tests/launch/stack_folder.h"

namespace hydro::launch {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;

// Waits for the two controllers, then ends the run as the plant does.
constexpr char kShortRun[] =
    "status ready;await 2;say tick;stop 0 the run is complete after 1 s;status done;exit 0";

// Tests that a stop published by the plant ends the run with 0, and that the launch adds nothing but its own
// lines.
TEST(LaunchTest, PlantEndsTheRun) {
  StackFolder stack;
  stack.Script("plant", kShortRun);
  auto launch = stack.Launch();
  EXPECT_EQ(launch->WaitForExit(), 0) << launch->text();
  EXPECT_THAT(launch->out(), Contains("[plant]         tick"));
  EXPECT_THAT(launch->out(), Contains("[launch]        stopped by plant: the run is complete after 1 s"));
  EXPECT_THAT(launch->out(), Contains("[pressure_ctrl] got stop: the run is complete after 1 s"));
  EXPECT_THAT(launch->out(), Contains("[position_ctrl] got stop: the run is complete after 1 s"));
  EXPECT_THAT(launch->err(), IsEmpty());
}

// Tests that --quiet leaves out the lines on stdout, and asks each process for errors alone.
TEST(LaunchTest, QuietAsksTheProcessesToo) {
  for (const bool quiet : {true, false}) {
    StackFolder stack;
    stack.Script("plant", std::string("quiet;") + kShortRun);
    auto launch = stack.Launch(quiet ? std::vector<std::string>{"--quiet"} : std::vector<std::string>{});
    EXPECT_EQ(launch->WaitForExit(), 0) << launch->text();
    EXPECT_EQ(launch->out().empty(), quiet) << launch->text();
    EXPECT_THAT(launch->err(),
                ::testing::ElementsAre(quiet ? "[plant]         quiet" : "[plant]         not quiet"));
  }
}

// Tests that the launch says when all are ready.
TEST(LaunchTest, SaysWhenAllAreReady) {
  StackFolder stack;
  auto launch = stack.Launch();
  EXPECT_THAT(launch->WaitForLine("ready after"),
              MatchesRegex("\\[launch\\] +all 3 processes ready after [0-9.]+ s"));
  launch->Signal(SIGINT);
  EXPECT_EQ(launch->WaitForExit(), 0) << launch->text();
}

// Tests that the logger is stopped after all others have ended, and that the plant is told to wait for it.
TEST(LaunchTest, LoggerIsStoppedLast) {
  StackFolder stack;
  stack.Script("plant", "arguments;status ready;wait;say plant ends");
  stack.Script("pressure_ctrl", "status ready;wait;say pressure ends");
  stack.Script("position_ctrl", "status ready;wait;say position ends");
  stack.Script("logger", "arguments;status ready;wait-term;say logger ends");
  auto launch = stack.Launch({"--log", "a.lcmlog", "--set", "position.c1=300"});
  launch->WaitForLine("all 4 processes ready");
  launch->Signal(SIGTERM);
  EXPECT_EQ(launch->WaitForExit(), 0) << launch->text();
  std::map<std::string, std::size_t> at;
  for (std::size_t i = 0; i < launch->out().size(); ++i) at[launch->out()[i]] = i;
  const std::size_t logger = at.at("[logger]        logger ends");
  EXPECT_GT(logger, at.at("[plant]         plant ends"));
  EXPECT_GT(logger, at.at("[pressure_ctrl] pressure ends"));
  EXPECT_GT(logger, at.at("[position_ctrl] position ends"));
  EXPECT_TRUE(at.contains("[launch]        stopped by SIGTERM"));
  const std::string config = stack.config();
  EXPECT_THAT(launch->out(),
              Contains("[plant]         arguments " + config + " --set position.c1=300 --expect logger"));
  EXPECT_THAT(launch->out(),
              Contains("[logger]        arguments " + config + " --set position.c1=300 -o a.lcmlog"));
}

// Tests that heavy output from all processes at once arrives complete: every line once, in order, with its
// label, on its stream.
TEST(LaunchTest, HeavyOutputKeepsItsLines) {
  constexpr int kLines = 20000;
  StackFolder stack;
  for (const char* role : {"pressure_ctrl", "position_ctrl"}) {
    stack.Script(role, "status ready;print " + std::to_string(kLines) + ";wait");
  }
  stack.Script("plant", "status ready;print " + std::to_string(kLines) + ";endless;" + kShortRun);
  auto launch = stack.Launch();
  EXPECT_EQ(launch->WaitForExit(), 0);
  for (const auto* stream : {&launch->out(), &launch->err()}) {
    std::map<std::string, int> next;
    for (const std::string& line : *stream) {
      ASSERT_TRUE(line.starts_with("[") && line.size() > 16) << line;
      std::string role = line.substr(1, line.find(']') - 1);
      if (line.find(" of the test's output") == std::string::npos) continue;
      std::string expected = "[" + role + "]";
      expected.resize(16, ' ');
      expected += role + " line " + std::to_string(next[role]++) + " of the test's output";
      ASSERT_EQ(line, expected);
    }
    for (const char* role : {"plant", "pressure_ctrl", "position_ctrl"})
      EXPECT_EQ(next[role], kLines) << role;
  }
  EXPECT_THAT(launch->out(), Contains("[plant]         no endtick"));
}

// Tests that the statistics and faults of all processes are in the table at the end.
TEST(LaunchTest, PrintsTimingAndFaults) {
  StackFolder stack;
  stack.Script("pressure_ctrl", "status ready;fault;gone;wait;statistics");
  auto launch = stack.Launch();
  launch->WaitForLine("all 3 processes ready");
  launch->Signal(SIGINT);
  EXPECT_EQ(launch->WaitForExit(), 0);
  EXPECT_THAT(launch->WaitForLine("pressure_ctrl   1000"), HasSubstr(" 345      7    3"));
  EXPECT_THAT(launch->WaitForLine("fault over_pressure"), HasSubstr("p1 is 2100 psi, allowed are 2000 psi"));
}

// Tests that a run that ends with an active fault has failed, however it ended, and that one that ends with a
// warning, or with a fault that is over, has not.
TEST(LaunchTest, AFaultAtTheEndIsAFailure) {
  const struct {
    const char* says;
    int exit_code;
  } ends[] = {{"fault other_stack", 1},
              {"fault stale_pressure_command", 1},
              {"fault a_code_of_a_later_version", 1},
              {"fault other_stack;gone other_stack", 0},
              {"fault undecodable_message", 0}};
  for (const auto& end : ends) {
    StackFolder stack;
    stack.Script("pressure_ctrl", "status ready;" + std::string(end.says) + ";wait;status done");
    stack.Script("plant", kShortRun);
    auto launch = stack.Launch();
    EXPECT_EQ(launch->WaitForExit(), end.exit_code) << end.says << "\n" << launch->text();
    if (end.exit_code == 1) {
      EXPECT_THAT(launch->err(), Contains(HasSubstr("ended with active faults: ")));
    } else {
      EXPECT_THAT(launch->err(), IsEmpty());
    }
  }
  StackFolder stack;
  stack.Script("pressure_ctrl", "status ready;fault other_stack;wait;status done");
  auto launch = stack.Launch();
  launch->WaitForLine("all 3 processes ready");
  launch->Signal(SIGINT);
  EXPECT_EQ(launch->WaitForExit(), 1);
  EXPECT_THAT(launch->err(), Contains(HasSubstr("other_stack of pressure_ctrl")));
}

// Tests that only the processes of the given host are started.
TEST(LaunchTest, HostFilter) {
  StackFolder stack;
  stack.WriteConfig(
      "[[process]]\nprogram = \"hydro-plant\"\nhost = \"rig\"\n[[process]]\nprogram = "
      "\"hydro-pressure-ctrl\"\n"
      "host = \"rig\"\n[[process]]\nprogram = \"hydro-position-ctrl\"\nhost = \"desk\"\n");
  auto launch = stack.Launch({"--host", "rig"});
  launch->WaitForLine("all 2 processes ready");
  launch->Signal(SIGINT);
  EXPECT_EQ(launch->WaitForExit(), 0);
  EXPECT_EQ(launch->text().find("[position_ctrl]"), std::string::npos);

  auto without = stack.Launch();
  EXPECT_EQ(without->WaitForExit(), 2);
  EXPECT_THAT(without->text(), HasSubstr("desk, rig"));
}

// Tests that the parts of one stack on two hosts (here: two launches) end together, both with the right code.
TEST(LaunchTest, TwoLaunchesEndTogether) {
  StackFolder stack;
  stack.WriteConfig(
      "[[process]]\nprogram = \"hydro-plant\"\nhost = \"rig\"\n[[process]]\nprogram = "
      "\"hydro-position-ctrl\"\n"
      "host = \"desk\"\n[[process]]\nprogram = \"hydro-logger\"\nhost = \"store\"\n");
  auto rig = stack.Launch({"--host", "rig", "--log", "a.lcmlog"});
  auto desk = stack.Launch({"--host", "desk", "--log", "a.lcmlog"});
  auto store = stack.Launch({"--host", "store", "--log", "a.lcmlog"});
  for (auto* launch : {rig.get(), desk.get(), store.get()}) launch->WaitForLine("1 process ready");
  rig->Signal(SIGINT);
  EXPECT_EQ(rig->WaitForExit(), 0) << rig->text();
  EXPECT_EQ(desk->WaitForExit(), 0) << desk->text();
  EXPECT_EQ(store->WaitForExit(), 0) << store->text();
  EXPECT_THAT(desk->text(), HasSubstr("stopped by launch: stopped by SIGINT"));
  EXPECT_THAT(store->text(), HasSubstr("[logger] got SIGTERM"));
}

}  // namespace
}  // namespace hydro::launch
