// Whose states a log holds, and the clock that stamped it.
#include "runs/recorded/senders.h"

#include <gmock/gmock.h>

#include "runs/info.h"
#include "runs/recorded/run_table.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

using testing::AllOf;
using testing::HasSubstr;

RunMessages RunOf(int64_t session, double arm_offset, int64_t ticks = 20) {
  RunMessages run = log::SampleRun(ticks);
  for (state_t& state : run.Of<state_t>()) {
    state.session = session;
    state.arm_angle += arm_offset;
  }
  for (auto& reference : run.Of<arm_reference_t>()) {
    reference.session = session;
    reference.value += arm_offset;
  }
  return run;
}

void Append(const RunMessages& from, RunMessages* to) {
  bus::ForEachMessage([&]<class Message>(const bus::MessageRow<Message>&) {
    const auto& more = from.Of<Message>();
    to->Of<Message>().insert(to->Of<Message>().end(), more.begin(), more.end());
  });
}

class SendersTest : public log::LogTest {
 protected:
  RunLog Log(const RunMessages& run) {
    log::WriteRun(Path("log"), run);
    return ReadRunLog(Path("log"));
  }
};

// Tests that one run is one, with messages repeated, late or lost.
TEST_F(SendersTest, OneRun) {
  RunMessages run = log::SampleRun(20);
  run.Of<state_t>().push_back(run.Of<state_t>()[3]);
  std::swap(run.Of<state_t>()[5], run.Of<state_t>()[8]);
  EXPECT_FALSE(HoldsSeveralRuns(run));
  ASSERT_EQ(RunsIn(run).size(), 1u);
  EXPECT_EQ(RunsIn(run)[0].messages.Of<state_t>().size(), 21u);
  RequireOneRun(Log(run));
  EXPECT_FALSE(Summarise(Log(run), false).several_runs);
}

// Tests that runs of two senders are refused by those who want one, and told apart by info: each with its own
// range.
TEST_F(SendersTest, TwoSenders) {
  RunMessages both = RunOf(11, 0);
  Append(RunOf(21, 100), &both);
  const RunLog log = Log(both);
  EXPECT_THAT(
      log::InputErrorOf([&] { RequireOneRun(log); }),
      AllOf(HasSubstr("found states from 2 senders on HYDRO_STATE, 2 runs (two different states of tick 0)"),
            HasSubstr("one run by one sender is needed"), HasSubstr("hydro-log info")));
  EXPECT_THAT(log::InputErrorOf([&] { ExportRun(log); }),
              HasSubstr("found states from 2 senders on HYDRO_STATE, 2 runs"));
  const LogInfo info = Summarise(log, false);
  ASSERT_EQ(info.senders.size(), 2u);
  EXPECT_TRUE(info.signals.empty());
  for (size_t k = 0; k < 2; ++k) {
    const SenderInfo& sender = info.senders[k];
    EXPECT_EQ(sender.ticks.states, 20);
    for (const SignalInfo& signal : sender.signals) {
      if (signal.name == "arm_angle") {
        EXPECT_EQ(signal.min, k == 0 ? 0 : 100);
      }
      if (signal.name == "arm_ref") {
        EXPECT_EQ(signal.max, k == 0 ? 15.2 : 115.2);
      }
    }
  }
  EXPECT_THAT(InfoText(info),
              AllOf(HasSubstr("run 1 of 2, by sender 0x000000000000000b: hydro-sim, seed 7"),
                    HasSubstr("run 2 of 2, by sender 0x0000000000000015: does not describe itself")));
  EXPECT_THAT(InfoJson(info), AllOf(HasSubstr("\"several_runs\": true"), HasSubstr("\"session\": 21")));
}

// Tests that two runs of one session are found by states that contradict each other, and split where their
// numbers begin again; and that mixed ones are not split by guessing.
TEST_F(SendersTest, OneSession) {
  RunMessages both = RunOf(0, 0);
  Append(RunOf(0, 100), &both);
  EXPECT_TRUE(HoldsSeveralRuns(both));
  ASSERT_EQ(RunsIn(both).size(), 2u);
  EXPECT_EQ(RunsIn(both)[1].messages.Of<state_t>().front().arm_angle, 100);
  EXPECT_THAT(
      log::InputErrorOf([&] { RequireOneRun(Log(both)); }),
      HasSubstr("found states of two runs with one session on HYDRO_STATE (two different states of tick 0)"));
  RunMessages mixed;
  const RunMessages a = RunOf(0, 0), b = RunOf(0, 100);
  for (size_t k = 0; k < 20; ++k) {
    mixed.Of<state_t>().push_back(a.Of<state_t>()[k]);
    mixed.Of<state_t>().push_back(b.Of<state_t>()[k]);
  }
  EXPECT_TRUE(RunsIn(mixed).empty());
}

// Tests that messages of other processes go to the run that was recorded around their time.
TEST_F(SendersTest, ByTime) {
  RunMessages both = RunOf(11, 0);
  RunMessages later = RunOf(21, 100);
  for (state_t& state : later.Of<state_t>()) state.utime += 60'000'000;
  for (motor_command_t& command : later.Of<motor_command_t>()) {
    command.utime += 60'000'000;
    command.session = 22;
  }
  Append(later, &both);
  const std::vector<SenderMessages> runs = RunsIn(both);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].messages.Of<motor_command_t>().size(), 20u);
  ASSERT_EQ(runs[1].messages.Of<motor_command_t>().size(), 20u);
  EXPECT_EQ(runs[1].messages.Of<motor_command_t>().front().session, 22);
}

// Tests that the clock's steps are found against plant time, and that duration and rates leave them out.
TEST_F(SendersTest, ClockSteps) {
  log::WriteRun(Path("log"), log::SampleRun(101));
  for (const int64_t step : {int64_t{600'000'000}, int64_t{-3'000'000}}) {
    std::vector<log::EventContents> events = log::ReadEvents(Path("log"));
    for (size_t k = events.size() / 2; k < events.size(); ++k) events[k].utime += step;
    log::WritePlain(Path("stepped"), events);
    const LogInfo info = Summarise(ReadRunLog(Path("stepped")), false);
    ASSERT_EQ(info.clock_steps.size(), 1u);
    EXPECT_NEAR(info.clock_steps[0].seconds, static_cast<double>(step) * 1e-6, 0.002);
    EXPECT_NEAR(info.clock_steps[0].at_time_s, 0.05, 0.002);
    EXPECT_NEAR(info.duration_s, 0.1, 0.002);
    for (const ChannelInfo& channel : info.channels) {
      if (channel.summary.channel == "HYDRO_STATE") {
        EXPECT_NEAR(channel.rate_hz, 1000, 20);
      }
    }
    EXPECT_THAT(InfoText(info),
                HasSubstr(step > 0 ? "clock: 600 s without a message" : "clock: set back by 3 s"));
  }
  EXPECT_TRUE(ReadRunLog(Path("log")).clock_steps.empty());
}

// Tests that recordings that were joined last as long as they do together, whatever the clock did between
// them.
TEST_F(SendersTest, JoinedRecordings) {
  log::WriteRun(Path("log"), log::SampleRun(101));
  for (const int64_t between : {int64_t{3600'000'000}, int64_t{-50'000}, int64_t{-86400'000'000}}) {
    std::vector<log::EventContents> both = log::ReadEvents(Path("log"));
    const int64_t end = both.back().utime;
    for (log::EventContents event : log::ReadEvents(Path("log"))) {
      event.utime += end + between;
      both.push_back(event);
    }
    log::WritePlain(Path("joined"), both);
    const LogInfo info = Summarise(ReadRunLog(Path("joined")), false);
    ASSERT_EQ(info.clock_steps.size(), 1u);
    EXPECT_TRUE(info.clock_steps[0].joined);
    EXPECT_NEAR(info.duration_s, 0.2, 0.002);
    for (const ChannelInfo& channel : info.channels) {
      if (channel.summary.channel == "HYDRO_STATE") {
        EXPECT_NEAR(channel.rate_hz, 1000, 20);
      }
    }
    EXPECT_THAT(InfoText(info),
                HasSubstr(between > 0 ? "clock: another run begins, 3600 s after the one before has ended"
                                      : "s earlier by its clock than the one before has ended"));
  }
}

// Tests that rows far apart, as of a slow recording, are no silence, and that a plant time that begins again
// is another run.
TEST(ClockWatchTest, SlowStates) {
  ClockWatch slow;
  for (int64_t k = 0; k < 10; ++k) slow.Take(k, 10'000'000 * k, 10.0 * static_cast<double>(k));
  EXPECT_TRUE(slow.steps().empty());
  ClockWatch joined;  // another run, whose time begins again
  joined.Take(0, 5'000'000, 5.0);
  joined.Take(1, 0, 0.0);
  joined.Take(2, 1000, 0.001);
  ASSERT_EQ(joined.steps().size(), 1u);
  EXPECT_TRUE(joined.steps()[0].joined);
  EXPECT_EQ(joined.steps()[0].seconds, -5);
}

}  // namespace
}  // namespace hydro::runs
