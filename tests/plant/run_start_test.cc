#include "plant/run_start.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hydro/log_progress_t.hpp>
#include <vector>

#include "bus/in_process_bus.h"
#include "tests/stack_fixture.h"

namespace hydro::plant {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

process_status_t Status(const std::string& role, int64_t session, int8_t state) {
  process_status_t status;
  status.role = role;
  status.session = session;
  status.state = state;
  status.host = "rig";
  status.pid = 12;
  return status;
}

// Tests that a missing participant is known by role until it says that it is ready.
TEST(RollCallTest, NamesWhoIsMissing) {
  RollCall roll({"pressure_ctrl", "position_ctrl"});
  EXPECT_THAT(roll.Missing(), ElementsAre("pressure_ctrl", "position_ctrl"));
  roll.Observe(Status("pressure_ctrl", 1, process_status_t::READY));
  EXPECT_THAT(roll.Missing(), ElementsAre("position_ctrl"));
  roll.Observe(Status("position_ctrl", 2, process_status_t::RUNNING));
  EXPECT_THAT(roll.Missing(), IsEmpty());
  EXPECT_EQ(roll.left(), "");
}

// Tests that a participant that leaves is named, unless it belongs to another run and was never seen here.
TEST(RollCallTest, NamesWhoLeft) {
  RollCall roll({"pressure_ctrl"});
  roll.Observe(Status("pressure_ctrl", 9, process_status_t::DONE));
  EXPECT_EQ(roll.left(), "");
  roll.Observe(Status("pressure_ctrl", 1, process_status_t::READY));
  roll.Observe(Status("pressure_ctrl", 1, process_status_t::FAILED));
  EXPECT_THAT(roll.left(), HasSubstr("pressure_ctrl on rig (process 12)"));
  EXPECT_THAT(roll.Missing(), ElementsAre("pressure_ctrl"));
}

// Tests that participants with one session, as on a simulated clock, are told apart by role, and that loggers
// are known.
TEST(RollCallTest, TellsRolesApart) {
  RollCall roll({"pressure_ctrl", "position_ctrl"});
  roll.Observe(Status("pressure_ctrl", 0, process_status_t::READY));
  roll.Observe(Status("position_ctrl", 0, process_status_t::READY));
  roll.Observe(Status("logger", 5, process_status_t::READY));
  EXPECT_THAT(roll.Missing(), IsEmpty());
  EXPECT_THAT(roll.Loggers(), ElementsAre(5));
}

// Tests that of a flood of made-up loggers only as many as a stack could have are kept, and that the known
// ones are still heard.
TEST(RollCallTest, KeepsNoFlood) {
  RollCall roll({"pressure_ctrl"});
  roll.Observe(Status("pressure_ctrl", 1, process_status_t::READY));
  for (int64_t session = 0; session < 10000; ++session) {
    roll.Observe(Status("logger", session, process_status_t::READY));
  }
  EXPECT_LE(roll.Loggers().size(), 256u);
  roll.Observe(Status("pressure_ctrl", 1, process_status_t::FAILED));
  EXPECT_THAT(roll.left(), HasSubstr("pressure_ctrl"));
}

// A process that begins a run on a simulated clock.
class RunStartTest : public ::testing::Test {
 protected:
  RunStart::Options Options(const std::vector<std::string>& roles) {
    RunStart::Options options;
    options.roles = roles;
    options.loggers = {bus::Channels("_knee"), bus::Channels("")};
    options.timeout_s = 3;
    options.description = DescriptionOf(testing::SmallStack(), "hydro-test");
    return options;
  }

  void Handle() {
    while (bus_.HandleUntil(clock_.Now()) > 0) {
    }
  }

  bus::SimulatedClock clock_;
  bus::InProcessBus bus_{&clock_};
  process::Participant participant_{bus_, clock_, bus::Channels("_knee"), "plant"};
  SiblingFaults siblings_{participant_, {}, {}};
  std::vector<run_description_t> descriptions_;
};

// Tests that a run waits for whoever is expected, that loggers may speak on the limb's channels and others
// may not, and that the run knows with whom it began.
TEST_F(RunStartTest, WaitsForWhoeverIsExpected) {
  RunStart start(participant_, siblings_, Options({"pressure_ctrl", "logger"}));
  bus_.Publish("HYDRO_PROCESS_STATUS", Status("pressure_ctrl", 7, process_status_t::READY));
  bus_.Publish("HYDRO_PROCESS_STATUS", Status("logger", 8, process_status_t::READY));
  int polls = 0;
  const auto announce = [&](bus::Clock::TimePoint) {
    if (++polls == 3) {
      bus_.Publish("HYDRO_PROCESS_STATUS_knee", Status("pressure_ctrl", 1, process_status_t::READY));
    }
  };
  EXPECT_TRUE(start.Await([] { return false; }, announce));
  EXPECT_GE(polls, 3);
  start.Begin();
  EXPECT_EQ(participant_.state(), process_status_t::RUNNING);
  EXPECT_TRUE(start.BeganWith(1));
  EXPECT_TRUE(start.BeganWith(8));
  EXPECT_FALSE(start.BeganWith(7));
  EXPECT_EQ(start.Departure(5), "");
  bus_.Publish("HYDRO_PROCESS_STATUS", Status("logger", 8, process_status_t::DONE));
  Handle();
  EXPECT_EQ(start.Departure(5), "logger on rig (process 12) has left the lockstep run at tick 5");
}

// Tests that the wait ends after its time with a stop that names who is missing, and at once when the run has
// ended.
TEST_F(RunStartTest, NamesWhoIsMissing) {
  RunStart start(participant_, siblings_, Options({"pressure_ctrl", "logger"}));
  const auto began = clock_.Now();
  EXPECT_FALSE(start.Await([] { return true; }, [](bus::Clock::TimePoint) {}));
  EXPECT_EQ(clock_.Now(), began);
  EXPECT_FALSE(start.Await([] { return false; }, [](bus::Clock::TimePoint) {}));
  EXPECT_EQ(bus::ToSeconds(clock_.Now() - began), 3);
  ASSERT_TRUE(participant_.stop());
  EXPECT_EQ(participant_.stop()->reason, "not ready after 3 s (time.start_timeout_s): pressure_ctrl, logger");
  EXPECT_EQ(participant_.stop()->exit_code, 1);
}

// Tests that the description, with the sender's identity, is repeated once a second and not more often.
TEST_F(RunStartTest, DescribesTheRunOnceASecond) {
  bus_.Subscribe<run_description_t>("HYDRO_RUN_knee", [this](const auto& d) { descriptions_.push_back(d); });
  RunStart start(participant_, siblings_, Options({}));
  const auto began = clock_.Now();
  for (int i = 0; i <= 25; ++i) {
    bus_.HandleUntil(began + i * std::chrono::milliseconds(100));
    start.Poll(clock_.Now());
  }
  Handle();
  ASSERT_EQ(descriptions_.size(), 3u);
  EXPECT_EQ(descriptions_[0].program, "hydro-test");
  EXPECT_EQ(descriptions_[0].session, participant_.session());
  EXPECT_EQ(descriptions_[0].host, participant_.host());
}

// Tests that a run is held up by each logger that was present when it began, and by no other.
TEST_F(RunStartTest, LoggersOfTheRunHoldItUp) {
  LoggerWindow window(bus_, {bus::Channels("")});
  EXPECT_TRUE(window.HasTaken(1000));
  window.Await({8, 9});
  EXPECT_TRUE(window.HasTaken(-1));
  EXPECT_FALSE(window.HasTaken(0));
  for (const auto& [session, tick] : {std::pair(8, 50), std::pair(9, 40), std::pair(77, 0)}) {
    log_progress_t progress{};
    progress.session = session;
    progress.tick = tick;
    bus_.Publish("HYDRO_LOG_PROGRESS", progress);
  }
  Handle();
  EXPECT_TRUE(window.HasTaken(40));
  EXPECT_FALSE(window.HasTaken(41));
}

}  // namespace
}  // namespace hydro::plant
