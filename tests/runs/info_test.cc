#include "runs/info.h"

#include <gmock/gmock.h>

#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

using testing::HasSubstr;
using testing::Not;

class InfoTest : public log::LogTest {
 protected:
  LogInfo InfoOf(const RunMessages& run, bool si = false) {
    log::WriteRun(Path("log"), run);
    return Summarise(ReadRunLog(Path("log")), si);
  }
};

const ChannelInfo& Channel(const LogInfo& info, const std::string& name) {
  for (const ChannelInfo& channel : info.channels) {
    if (channel.summary.channel == name) return channel;
  }
  throw std::out_of_range(name);
}

const SignalInfo& Signal(const LogInfo& info, const std::string& name) {
  for (const SignalInfo& signal : info.signals) {
    if (signal.name == name) return signal;
  }
  throw std::out_of_range(name);
}

// Tests the figures of a complete run.
TEST_F(InfoTest, CompleteRun) {
  const LogInfo info = InfoOf(log::SampleRun(101));
  EXPECT_DOUBLE_EQ(info.duration_s, 0.1);
  EXPECT_EQ(info.ticks.states, 101);
  EXPECT_EQ(info.ticks.last, 100);
  EXPECT_DOUBLE_EQ(info.ticks.rate_hz, 1000);
  EXPECT_EQ(info.ticks.gaps, 0);
  const ChannelInfo& state = Channel(info, "HYDRO_STATE");
  EXPECT_DOUBLE_EQ(state.rate_hz, 1000);
  EXPECT_EQ(state.missing, 0);
  EXPECT_EQ(state.repeated, 0);
  EXPECT_DOUBLE_EQ(Channel(info, "HYDRO_PRESSURE_COMMAND").rate_hz, 200);
  EXPECT_EQ(info.model_name, "Table 1");
  EXPECT_EQ(info.config, (std::vector<std::pair<std::string, std::string>>{{"plant.rate_hz", "1000"}}));
  EXPECT_EQ(Signal(info, "p1").min, 100);
  EXPECT_EQ(Signal(info, "p1").max, 100 + 100.0 / 7);
  EXPECT_EQ(info.faults.size(), 1u);
}

// Tests that lost, repeated and late-joined messages are counted by sender.
TEST_F(InfoTest, LostAndRepeatedMessages) {
  RunMessages run = log::SampleRun(20);
  run.Of<state_t>().erase(run.Of<state_t>().begin() + 5, run.Of<state_t>().begin() + 8);  // ticks 5 to 7
  run.Of<state_t>().push_back(run.Of<state_t>()[2]);
  run.Of<motor_command_t>().erase(run.Of<motor_command_t>().begin(), run.Of<motor_command_t>().begin() + 4);
  run.Of<motor_command_t>()[10].session = 77;  // a second sender: its numbers are its own
  run.Of<motor_command_t>()[10].sequence = 0;
  const LogInfo info = InfoOf(run);
  EXPECT_EQ(Channel(info, "HYDRO_STATE").missing, 3);
  EXPECT_EQ(Channel(info, "HYDRO_STATE").repeated, 1);
  EXPECT_EQ(Channel(info, "HYDRO_MOTOR_COMMAND").before_first, 4);
  EXPECT_EQ(Channel(info, "HYDRO_MOTOR_COMMAND").missing, 1);
  EXPECT_EQ(Channel(info, "HYDRO_MOTOR_COMMAND").senders, 2);
  EXPECT_EQ(info.ticks.states, 17);
  EXPECT_EQ(info.ticks.gaps, 1);
  EXPECT_EQ(info.ticks.missing, 3);
  EXPECT_EQ(info.ticks.announced, 0);
}

// Tests that ticks that the plant reports as skipped are told from lost ones.
TEST_F(InfoTest, SkippedTicks) {
  RunMessages run = log::SampleRun(20);
  run.Of<state_t>().erase(run.Of<state_t>().begin() + 5, run.Of<state_t>().begin() + 8);
  run.Of<state_t>()[5].skipped_ticks = 2;
  const LogInfo info = InfoOf(run);
  EXPECT_EQ(info.ticks.missing, 3);
  EXPECT_EQ(info.ticks.announced, 2);
}

// Tests that the configuration is shown key by key, with values of any kind on one line.
TEST_F(InfoTest, ConfigurationOfTheRun) {
  log::WriteRun(
      Path("log"), log::SampleRun(2), "",
      "[[process]]\nprogram = \"a\"\ncpu = 1\n[limits]\nstale_input_s = 0.1\n[time]\nmode = \"lockstep\"\n"
      "[reference]\nsteps = [[0.2, 0.3], [2.2, -0.2]]\n");
  using Entry = std::pair<std::string, std::string>;
  EXPECT_THAT(Summarise(ReadRunLog(Path("log")), false).config,
              testing::ElementsAre(
                  Entry("limits.stale_input_s", "0.1"), Entry("process", "[{cpu = 1, program = 'a'}]"),
                  Entry("reference.steps", "[[0.2, 0.3], [2.2, -0.2]]"), Entry("time.mode", "'lockstep'")));
}

// Tests that a log whose description is damaged still tells what it holds, and that no unit is guessed.
TEST_F(InfoTest, DamagedDescription) {
  log::WriteRun(Path("log"), log::SampleRun(20), "", "[plant]\nrate_hz = 1000\n", "name \x1d \"Table 1\"\n");
  const LogInfo info = Summarise(ReadRunLog(Path("log")), false);
  EXPECT_EQ(info.ticks.states, 20);
  EXPECT_EQ(Signal(info, "p1").min, 100);
  EXPECT_EQ(Signal(info, "p1").unit, "");
  EXPECT_EQ(Signal(info, "motor_speed").unit, "rad/s");
  EXPECT_EQ(info.config.size(), 1u);
  EXPECT_EQ(info.model_name, "");
  EXPECT_THAT(info.description_fault, HasSubstr("run description: model:1: syntax: "));
  EXPECT_THAT(InfoText(info), HasSubstr("run: not known: " + Path("log") + ": run description: model:1"));
  EXPECT_THAT(InfoText(info), HasSubstr("\np1  "));
  log::WriteRun(Path("log"), log::SampleRun(20), "", "[plant\nrate_hz = 1000\n");
  const LogInfo config = Summarise(ReadRunLog(Path("log")), false);
  EXPECT_EQ(config.model_name, "Table 1");
  EXPECT_EQ(Signal(config, "p1").unit, "psi");
  EXPECT_THAT(config.description_fault, HasSubstr("run description: configuration:1: syntax: "));
}

// Tests that a stop repeated against loss is reported once, and another sender's too.
TEST_F(InfoTest, RepeatedStops) {
  RunLog log;
  for (const int64_t session : {1, 2, 2, 2, 1}) {
    stop_t stop{};
    stop.session = session;
    stop.reason = "the run is complete";
    log.messages.Of<stop_t>().push_back(stop);
  }
  EXPECT_EQ(Summarise(log, false).stops.size(), 2u);
}

// Tests that a stop over the bus, which knows no tick, and the plant's, which it asked over its socket, are
// one stop.
TEST_F(InfoTest, HandedOnStop) {
  for (const bool asker_first : {true, false}) {
    RunLog log;
    for (const bool asker : {asker_first, !asker_first}) {
      stop_t stop{};
      stop.session = asker ? 30 : 20;
      stop.source = "scope";
      stop.tick = asker ? -1 : 1596;
      stop.reason = "STOP on the page";
      log.messages.Of<stop_t>().push_back(stop);
    }
    const LogInfo info = Summarise(log, false);
    ASSERT_EQ(info.stops.size(), 1u);
    EXPECT_EQ(info.stops[0].tick, 1596);
  }
}

// Tests that figures are in SI on request.
TEST_F(InfoTest, SiUnits) {
  const LogInfo info = InfoOf(log::SampleRun(3), true);
  EXPECT_EQ(Signal(info, "p1").unit, "kPa");
  EXPECT_NEAR(Signal(info, "p1").min, 689.4757, 1e-3);
  EXPECT_EQ(Signal(info, "arm_angle").unit, "rad");
}

// Tests that signals are in the units of the model that the log describes, and in the same SI units.
TEST_F(InfoTest, ModelsOwnUnits) {
  log::WriteRun(Path("si"), log::SampleRun(3), "", "", "name = \"rig\"\nunits = \"si\"\n");
  const LogInfo own = Summarise(ReadRunLog(Path("si")), false);
  EXPECT_EQ(Signal(own, "p1").unit, "Pa");
  EXPECT_EQ(Signal(own, "p1").min, 100);
  const LogInfo si = Summarise(ReadRunLog(Path("si")), true);
  EXPECT_EQ(Signal(si, "p1").unit, "kPa");
  EXPECT_DOUBLE_EQ(Signal(si, "p1").min, 0.1);
  log::WriteRun(Path("cylinder"), log::SampleRun(3), "", "", "units = { arm = \"in\" }\n");
  const LogInfo cylinder = Summarise(ReadRunLog(Path("cylinder")), false);
  EXPECT_EQ(Signal(cylinder, "arm_speed").unit, "in/s");
  EXPECT_EQ(Signal(cylinder, "motor_speed").unit, "rad/s");
  EXPECT_EQ(Signal(cylinder, "p1").unit, "psi");
}

// Tests that the texts hold what matters, for a log with everything and for one with nothing.
TEST_F(InfoTest, Texts) {
  const LogInfo info = InfoOf(log::SampleRun(11));
  const std::string text = InfoText(info);
  for (const char* part :
       {"Table 1", "hydro-sim 1.2.3", "HYDRO_STATE", "stale_state", "plant.rate_hz = 1000"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_THAT(InfoJson(info), HasSubstr("\"model_name\": \"Table 1\""));
  log::WriteBytes(Path("empty"), "");
  const LogInfo nothing = Summarise(ReadRunLog(Path("empty")), false);
  EXPECT_THAT(InfoText(nothing), HasSubstr("0 messages"));
  EXPECT_THAT(InfoJson(nothing), HasSubstr("\"messages\": 0"));
}

// Tests that of a fault that came and went thousands of times the texts have the first and the last lines and
// how many lie between them, and JSON all.
TEST_F(InfoTest, FaultsOfADeviceThatFlickers) {
  LogInfo info = InfoOf(log::SampleRun(11));
  info.faults.clear();
  for (int i = 0; i < 5000; ++i) {
    fault_t fault{};
    fault.tick = i;
    fault.source = "driver";
    fault.code = "device_fault";
    fault.active = i % 2 == 0;
    info.faults.push_back(fault);
  }
  const std::string text = InfoText(info);
  for (const char* part :
       {"fault: tick 19: driver: device_fault has gone: ", "\n... and 4960 more ...\nfault: tick 4980: ",
        "fault: tick 4999: driver: device_fault has gone: "}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_THAT(text, Not(HasSubstr("fault: tick 20:")));
  EXPECT_THAT(text, Not(HasSubstr("fault: tick 4979:")));
  EXPECT_THAT(InfoJson(info), HasSubstr("\"tick\": 2500"));
  info.faults.resize(kListed);
  EXPECT_THAT(InfoText(info), Not(HasSubstr(" more ...")));
}

}  // namespace
}  // namespace hydro::runs
