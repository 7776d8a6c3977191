#include "launch/launch_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "tests/temporary_folder.h"

namespace hydro::launch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class LaunchPlanTest : public ::testing::Test {
 protected:
  LaunchPlanTest() {
    for (const char* program :
         {"hydro-plant", "hydro-pressure-ctrl", "hydro-position-ctrl", "hydro-logger"}) {
      MakeProgram(folder_ / program);
    }
    request_.config_file = "stack.toml";
  }

  static void MakeProgram(const std::filesystem::path& path) {
    std::ofstream(path) << "#!/bin/sh\n";
    chmod(path.c_str(), 0755);
  }
  void Processes(const std::vector<std::pair<std::string, std::string>>& program_and_host) {
    for (const auto& [program, host] : program_and_host) config_.processes.push_back({program, host, -1, 0});
  }
  LaunchPlan Plan() { return PlanLaunch(config_, request_, folder_.string()); }
  std::vector<std::string> Programs() {
    std::vector<std::string> programs;
    for (const ChildSpec& child : Plan().children) programs.push_back(child.program());
    return programs;
  }
  std::string Error() {
    try {
      Plan();
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
  settings::StackConfig config_;
  LaunchRequest request_;
};

// Tests that each process gets the configuration and every override, and is found in the folder.
TEST_F(LaunchPlanTest, PassesConfigurationAndOverrides) {
  Processes({{"hydro-plant", ""}, {"hydro-pressure-ctrl", "localhost"}});
  request_.overrides = {"time.mode=lockstep", "position.c1=2"};
  const LaunchPlan plan = Plan();
  ASSERT_EQ(plan.children.size(), 2u);
  EXPECT_EQ(plan.children[0].label, "plant");
  EXPECT_EQ(plan.children[1].label, "pressure_ctrl");
  EXPECT_FALSE(plan.spread);
  EXPECT_THAT(plan.children[1].argv, ElementsAre((folder_ / "hydro-pressure-ctrl").string(), "stack.toml",
                                                 "--set", "time.mode=lockstep", "--set", "position.c1=2"));
  EXPECT_EQ(plan.stop_command, "hydro-launch stack.toml --stop");
}

// Tests that the command that ends a stack on the same bus names that bus.
TEST_F(LaunchPlanTest, StopCommandNamesTheBus) {
  Processes({{"hydro-plant", ""}});
  request_.overrides = {"bus.url=udpm://239.1.2.3:7?ttl=0", "position.c1=2", "joint=knee"};
  EXPECT_EQ(Plan().stop_command,
            "hydro-launch stack.toml --stop --set 'bus.url=udpm://239.1.2.3:7?ttl=0' --set 'joint=knee'");
}

// Tests that a logger runs only with --log and is stopped last, and that the plant is told to wait for it.
TEST_F(LaunchPlanTest, LogAddsALogger) {
  Processes({{"hydro-plant", ""}, {"hydro-logger", ""}});
  EXPECT_THAT(Programs(), ElementsAre("hydro-plant"));
  request_.log_file = "a.lcmlog";
  const LaunchPlan plan = Plan();
  ASSERT_EQ(plan.children.size(), 2u);
  EXPECT_THAT(plan.children[0].argv,
              ElementsAre((folder_ / "hydro-plant").string(), "stack.toml", "--expect", "logger"));
  EXPECT_THAT(plan.children[1].argv,
              ElementsAre((folder_ / "hydro-logger").string(), "stack.toml", "-o", "a.lcmlog"));
  EXPECT_FALSE(plan.children[0].last);
  EXPECT_TRUE(plan.children[1].last);
}

// Tests that --log also starts a logger that no section mentions.
TEST_F(LaunchPlanTest, LogNeedsNoSection) {
  Processes({{"hydro-plant", ""}});
  request_.log_file = "a.lcmlog";
  EXPECT_THAT(Programs(), ElementsAre("hydro-plant", "hydro-logger"));
}

// Tests that --host takes only the processes of that host.
TEST_F(LaunchPlanTest, HostFilters) {
  Processes({{"hydro-plant", "rig"}, {"hydro-pressure-ctrl", "rig"}, {"hydro-position-ctrl", "desk"}});
  request_.host = "rig";
  EXPECT_THAT(Programs(), ElementsAre("hydro-plant", "hydro-pressure-ctrl"));
  EXPECT_TRUE(Plan().spread);
  request_.host = "desk";
  EXPECT_THAT(Programs(), ElementsAre("hydro-position-ctrl"));
}

// Tests that the logger runs on the host that its section names, and that the launch on the other host says
// where.
TEST_F(LaunchPlanTest, LoggerRunsOnItsHost) {
  Processes({{"hydro-plant", "rig"}, {"hydro-position-ctrl", "desk"}, {"hydro-logger", "desk"}});
  request_.log_file = "a.lcmlog";
  request_.host = "rig";
  const LaunchPlan plan = Plan();
  ASSERT_EQ(plan.children.size(), 1u);
  EXPECT_EQ(plan.children[0].argv.back(), "logger");
  EXPECT_THAT(plan.remarks, ElementsAre(HasSubstr("host desk")));
  request_.host = "desk";
  EXPECT_THAT(Programs(), ElementsAre("hydro-position-ctrl", "hydro-logger"));
}

// Tests that a stack over several hosts does not start without --host, and that the hosts are listed.
TEST_F(LaunchPlanTest, HostsNeedHost) {
  Processes({{"hydro-plant", "rig"}, {"hydro-pressure-ctrl", ""}, {"hydro-position-ctrl", "desk"}});
  EXPECT_THAT(Error(), HasSubstr("stack.toml: [[process]] names the hosts desk, rig; "));
}

// Tests that an unknown host is an error that lists the known ones.
TEST_F(LaunchPlanTest, UnknownHost) {
  Processes({{"hydro-plant", "rig"}, {"hydro-position-ctrl", "desk"}});
  request_.host = "dek";
  EXPECT_THAT(Error(), HasSubstr("--host dek: no such host"));
  EXPECT_THAT(Error(), HasSubstr("allowed: desk, rig"));
  config_.processes = {{"hydro-plant", "", -1, 0}};
  EXPECT_THAT(Error(), HasSubstr("allowed: none is named there"));
}

// Tests that a process without a host in a stack over hosts is pointed out.
TEST_F(LaunchPlanTest, ProcessWithoutHostIsPointedOut) {
  Processes({{"hydro-plant", "rig"}, {"hydro-position-ctrl", ""}});
  request_.host = "rig";
  EXPECT_THAT(Plan().remarks, ElementsAre(HasSubstr("hydro-position-ctrl names no host")));
}

// Tests that a host with only a logger, without --log, is an error instead of nothing at all.
TEST_F(LaunchPlanTest, NothingToStart) {
  Processes({{"hydro-plant", "rig"}, {"hydro-logger", "desk"}});
  request_.host = "desk";
  EXPECT_THAT(Error(), HasSubstr("nothing to start on host desk"));
}

// Tests that a driver that does not suit the configuration is refused before anything starts, and that it
// waits for the logger as the plant does.
TEST_F(LaunchPlanTest, ChecksTheDriver) {
  MakeProgram(folder_ / "hydro-driver");
  Processes({{"hydro-driver", ""}});
  EXPECT_THAT(Error(), HasSubstr("driver: found nothing, allowed a section [driver]"));
  config_.driver.emplace();
  config_.driver->arm_angle.source = settings::SensorSection::Source::kAnalog;
  request_.log_file = "a.lcmlog";
  const LaunchPlan plan = Plan();
  EXPECT_EQ(plan.children[0].label, "driver");
  EXPECT_THAT(plan.children[0].argv, ::testing::Contains("--expect"));
  config_.time.mode = settings::TimeMode::kLockstep;
  EXPECT_THAT(Error(), HasSubstr("time.mode: found \"lockstep\""));
}

// Tests that a stack which drives a machine is not started without its driver, for which the loops would wait
// without end; that any host may have it, and the model may stand for it.
TEST_F(LaunchPlanTest, ADriverIsMissing) {
  Processes({{"hydro-pressure-ctrl", ""}, {"hydro-position-ctrl", ""}});
  EXPECT_EQ(Error(), "no error");
  config_.driver.emplace().kind = settings::DriverKind::kOwn;
  EXPECT_EQ(Error(),
            "stack.toml: process: found none that drives the machine of [driver], allowed a section "
            "[[process]] with command = [...] and role = \"driver\", or with program = \"hydro-plant\" for "
            "the model instead");
  config_.driver->kind = settings::DriverKind::kComedi;
  EXPECT_THAT(Error(), HasSubstr("allowed a section [[process]] with program = \"hydro-driver\", or"));
  Processes({{"hydro-plant", "rig"}});
  request_.host = "localhost";
  EXPECT_EQ(Error(), "no error");
}

// Tests that a driver of the user's own is refused where the configuration is none for it, and else told to
// wait for the logger where there is one.
TEST_F(LaunchPlanTest, StartsADriverOfTheUsersOwn) {
  settings::ProcessSection& own = config_.processes.emplace_back();
  own.command = {"./crane"};
  own.role = "driver";
  request_.config_file = (folder_ / "stack.toml").string();
  MakeProgram(folder_ / "crane");
  EXPECT_THAT(Error(),
              HasSubstr("driver: found nothing, allowed a section [driver], which ./crane (driver) needs"));
  config_.driver.emplace();
  config_.driver->arm_angle.source = settings::SensorSection::Source::kAnalog;
  EXPECT_THAT(Error(), HasSubstr("driver.kind: found \"comedi\", allowed \"own\" with ./crane (driver)"));
  config_.driver->kind = settings::DriverKind::kOwn;
  const LaunchPlan alone = Plan();
  ASSERT_EQ(alone.children.size(), 1u);
  EXPECT_EQ(alone.children[0].label, "driver");
  EXPECT_THAT(alone.children[0].argv, ElementsAre((folder_ / "crane").string()));
  ASSERT_TRUE(alone.children[0].own);
  EXPECT_THAT(alone.children[0].own->environment,
              ::testing::IsSupersetOf({std::string("HYDRO_ROLE=driver"), std::string("HYDRO_EXPECT=")}));
  request_.log_file = "a.lcmlog";
  MakeProgram(folder_ / "hydro-logger");
  EXPECT_THAT(Plan().children[0].own->environment, ::testing::Contains("HYDRO_EXPECT=logger"));
  config_.time.mode = settings::TimeMode::kLockstep;
  EXPECT_THAT(Error(),
              HasSubstr("time.mode: found \"lockstep\", allowed \"realtime\" with ./crane (driver)"));
}

// Tests that a controller of the user's own is found from the configuration's folder, told where it takes
// part, runs on the host that its section names, and keeps its arguments.
TEST_F(LaunchPlanTest, StartsAProgramOfTheUsersOwn) {
  Processes({{"hydro-plant", ""}});
  settings::ProcessSection& own = config_.processes.emplace_back();
  own.command = {"./pid.py", "--gain", "2"};
  own.role = "position_ctrl";
  own.place = "stack.toml:7";
  own.cpu = 1;
  request_.config_file = (folder_ / "stack.toml").string();
  request_.overrides = {"position.c1=2", "time.mode=lockstep"};
  config_.position_interval_ticks = 25;
  EXPECT_THAT(Error(),
              HasSubstr("stack.toml:7: process.command: found \"./pid.py\", and there is no program"));
  MakeProgram(folder_ / "pid.py");

  const LaunchPlan plan = Plan();
  ASSERT_EQ(plan.children.size(), 2u);
  const ChildSpec& child = plan.children[1];
  EXPECT_EQ(child.label, "position_ctrl");
  EXPECT_EQ(child.role(), "position_ctrl");
  EXPECT_EQ(child.program(), "./pid.py --gain 2 (position_ctrl)");
  EXPECT_THAT(child.argv, ElementsAre((folder_ / "pid.py").string(), "--gain", "2"));
  ASSERT_TRUE(child.own);
  EXPECT_EQ(child.own->folder, folder_.string());
  EXPECT_EQ(child.own->cpu, 1);
  EXPECT_THAT(
      child.own->environment,
      ::testing::IsSupersetOf({std::string("HYDRO_ROLE=position_ctrl"), std::string("HYDRO_EVERY=25"),
                               std::string("HYDRO_POSITION_EVERY=25"),
                               "HYDRO_COMMAND_DELAY=" + std::to_string(config_.plant.command_delay_ticks),
                               std::string("HYDRO_TIME=realtime"), "HYDRO_CONFIG=" + request_.config_file,
                               std::string("HYDRO_SET=position.c1=2\ntime.mode=lockstep"),
                               "HYDRO_BUS_URL=" + config_.bus.url}));
  EXPECT_EQ(plan.children[0].role(), "plant");

  config_.processes[1].host = "desk";
  config_.processes[0].host = "rig";
  request_.host = "rig";
  EXPECT_THAT(Programs(), ElementsAre("hydro-plant"));
  request_.host = "desk";
  EXPECT_THAT(Programs(), ElementsAre("./pid.py --gain 2 (position_ctrl)"));
}

// Tests that a program is searched for in the folder first, then on PATH, and that a missing one is named.
TEST_F(LaunchPlanTest, FindsPrograms) {
  const std::string path_before = getenv("PATH");
  std::filesystem::create_directory(folder_ / "bin");
  MakeProgram(folder_ / "bin" / "hydro-plant");
  MakeProgram(folder_ / "bin" / "hydro-driver");
  setenv("PATH", (folder_ / "bin").c_str(), 1);
  Processes({{"hydro-plant", ""}, {"hydro-driver", ""}});
  config_.driver.emplace();
  config_.driver->arm_angle.source = settings::SensorSection::Source::kAnalog;
  EXPECT_EQ(Plan().children[0].argv[0], (folder_ / "hydro-plant").string());
  EXPECT_EQ(Plan().children[1].argv[0], (folder_ / "bin" / "hydro-driver").string());
  chmod((folder_ / "bin" / "hydro-driver").c_str(), 0644);  // not a program any more
  const std::string error = Error();
  setenv("PATH", path_before.c_str(), 1);
  EXPECT_THAT(error, HasSubstr("hydro-driver: program not found"));
  EXPECT_THAT(error, HasSubstr(folder_.string()));
}

}  // namespace
}  // namespace hydro::launch
