#include "plant/plant_app.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <hydro/fault_t.hpp>
#include <hydro/log_progress_t.hpp>
#include <vector>

#include "base/input_error.h"
#include "bus/in_process_bus.h"
#include "plant/simulated_rig.h"
#include "tests/plant/run_plant.h"
#include "tests/stack_fixture.h"

namespace hydro::plant {
namespace {

using ::testing::HasSubstr;
using testing::SmallStack;

// A plant on an in-process bus and a simulated clock; the test plays both controllers.
class PlantAppTest : public ::testing::Test {
 protected:
  PlantAppTest() {
    bus_.Subscribe<state_t>("HYDRO_STATE", [this](const state_t& s) {
      states_.push_back(s);
      if (on_state_) on_state_(s);
    });
    bus_.Subscribe<fault_t>("HYDRO_FAULT", [this](const fault_t& f) { faults_.push_back(f); });
    bus_.Subscribe<stop_t>("HYDRO_STOP", [this](const stop_t& s) { stops_.push_back(s); });
  }

  int Run(const settings::StackConfig& config) {
    SimulatedRig rig(config);
    const PlantOutcome outcome = RunPlant(bus_, clock_, config, rig);
    failure_ = outcome.failure;
    return outcome.exit_code;
  }

  void SendVoltage(int64_t tick, double voltage, int64_t session = 1) {
    motor_command_t c{};
    c.tick = tick;
    c.session = session;
    c.sequence = sequence_++;
    c.voltage = voltage;
    bus_.Publish("HYDRO_MOTOR_COMMAND", c);
  }

  void SendPressureCommand(int64_t tick, int64_t session = 1) {
    pressure_command_t c{};
    c.tick = tick;
    c.session = session;
    bus_.Publish("HYDRO_PRESSURE_COMMAND", c);
  }

  // Answers every tick as both controllers would; the voltage is the tick's number in mV.
  void AnswerAll() {
    on_state_ = [this](const state_t& s) {
      if (s.tick % 5 == 0) SendPressureCommand(s.tick);
      SendVoltage(s.tick, 1e-3 * static_cast<double>(s.tick));
    };
  }

  bus::SimulatedClock clock_;
  bus::InProcessBus bus_{&clock_};
  std::function<void(const state_t&)> on_state_;
  std::vector<state_t> states_;
  std::vector<fault_t> faults_;
  std::vector<stop_t> stops_;
  std::string failure_;
  int64_t sequence_ = 0;
};

// Tests that a lockstep run publishes each tick once, from 0 to the last, and that the command computed from
// tick k acts from tick k + 1 on: over the interval that ends at tick k + 2.
TEST_F(PlantAppTest, LockstepAppliesCommandsOneTickLater) {
  AnswerAll();
  EXPECT_EQ(Run(SmallStack()), 0);
  ASSERT_EQ(states_.size(), 101u);
  for (int64_t k = 0; k <= 100; ++k) {
    EXPECT_EQ(states_[k].tick, k);
    EXPECT_EQ(states_[k].sequence, k);
    EXPECT_DOUBLE_EQ(states_[k].time, 1e-3 * static_cast<double>(k));
    EXPECT_EQ(states_[k].skipped_ticks, 0);
    if (k >= 2) {
      EXPECT_EQ(states_[k].command_tick, k - 2);
      EXPECT_DOUBLE_EQ(states_[k].voltage, 1e-3 * static_cast<double>(k - 2));
    } else {
      EXPECT_EQ(states_[k].command_tick, -1);
      EXPECT_EQ(states_[k].voltage, 0);
    }
  }
  ASSERT_EQ(stops_.size(), 1u);
  EXPECT_EQ(stops_[0].exit_code, 0);
  EXPECT_EQ(failure_, "");
}

// Tests that with a delay of 0 the command of tick k acts from tick k on.
TEST_F(PlantAppTest, LockstepWithoutDelay) {
  AnswerAll();
  settings::StackConfig config = SmallStack();
  config.plant.command_delay_ticks = 0;
  EXPECT_EQ(Run(config), 0);
  for (int64_t k = 1; k <= 100; ++k) EXPECT_EQ(states_[k].command_tick, k - 1);
}

// Tests that a pressure loop that does not answer ends a lockstep run with an error that names it, that the
// unanswered state is resent meanwhile, and that this takes less than 2 s.
TEST_F(PlantAppTest, LockstepNamesAStalledPressureLoop) {
  on_state_ = [this](const state_t& s) {
    if (s.tick % 5 == 0) SendPressureCommand(s.tick);
    if (s.tick < 7) SendVoltage(s.tick, 0);
  };
  EXPECT_EQ(Run(SmallStack()), 1);
  EXPECT_THAT(failure_, HasSubstr("pressure_ctrl has not answered tick 7"));
  EXPECT_EQ(states_.back().tick, 7);
  EXPECT_GT(states_.size(), 10u);
  EXPECT_LT(clock_.Now().time_since_epoch(), std::chrono::seconds(2));
  ASSERT_EQ(stops_.size(), 1u);
  EXPECT_EQ(stops_[0].exit_code, 1);
}

// Tests that a position loop that does not answer is the one named.
TEST_F(PlantAppTest, LockstepNamesAStalledPositionLoop) {
  on_state_ = [this](const state_t& s) { SendVoltage(s.tick, 0); };
  EXPECT_EQ(Run(SmallStack()), 1);
  EXPECT_THAT(failure_, HasSubstr("position_ctrl has not answered tick 0"));
}

// Tests that in lockstep nobody else's pressure command, nor one for a future tick, counts as the position
// loop's answer.
TEST_F(PlantAppTest, LockstepWaitsForItsOwnPositionLoop) {
  on_state_ = [this](const state_t& s) {
    SendVoltage(s.tick, 0);
    if (s.tick % 5 != 0) return;
    SendPressureCommand(s.tick, 99);
    SendPressureCommand(s.tick + 1);
    if (s.tick < 50) SendPressureCommand(s.tick);
  };
  EXPECT_EQ(Run(SmallStack()), 1);
  EXPECT_THAT(failure_, HasSubstr("position_ctrl has not answered tick 50"));
  EXPECT_EQ(states_.back().tick, 50);
}

// Tests that in lockstep the answer to an older tick that comes late, of either loop, does not take the
// newest one back.
TEST_F(PlantAppTest, LockstepLateAnswers) {
  on_state_ = [this](const state_t& s) {
    if (s.tick % 5 == 0) SendPressureCommand(s.tick);
    if (s.tick >= 5) SendPressureCommand(s.tick / 5 * 5 - 5);
    SendVoltage(s.tick, 1.0);
    if (s.tick == 40) SendVoltage(20, 1.0);
  };
  EXPECT_EQ(Run(SmallStack()), 0);
  EXPECT_EQ(states_.size(), 101u) << "no state was sent again";
  EXPECT_EQ(states_.back().tick, 100);
}

// Tests that a participant that says farewell during a lockstep run ends it at once, by name.
TEST_F(PlantAppTest, LockstepNamesWhoLeft) {
  on_state_ = [this](const state_t& s) {
    if (s.tick % 5 == 0) SendPressureCommand(s.tick);
    if (s.tick < 7) SendVoltage(s.tick, 0);
    if (s.tick == 7) {
      process_status_t done;
      done.session = 1;
      done.role = "pressure_ctrl";
      done.state = process_status_t::DONE;
      bus_.Publish("HYDRO_PROCESS_STATUS", done);
    }
  };
  EXPECT_EQ(Run(SmallStack()), 1);
  EXPECT_THAT(failure_, HasSubstr("pressure_ctrl"));
  EXPECT_THAT(failure_, HasSubstr("has left"));
  EXPECT_LT(clock_.Now().time_since_epoch(), std::chrono::milliseconds(200));
}

// Tests that a run does not start without its participants and names those missing.
TEST_F(PlantAppTest, NamesWhoIsNotReady) {
  const settings::StackConfig config = SmallStack();
  SimulatedRig rig(config);
  PlantApp plant(bus_, clock_, config, rig, {"logger"});
  process_status_t ready;
  ready.session = 1;
  ready.role = "pressure_ctrl";
  ready.state = process_status_t::READY;
  bus_.Publish("HYDRO_PROCESS_STATUS", ready);
  EXPECT_EQ(plant.Run(), 1);
  EXPECT_THAT(plant.failure(), HasSubstr("position_ctrl, logger"));
  EXPECT_TRUE(states_.empty());
}

// Tests that in lockstep the plant does not run far ahead of a logger that has fallen behind, and names it.
TEST_F(PlantAppTest, LockstepWaitsForTheLogger) {
  AnswerAll();
  process_status_t logger;
  logger.session = 8;
  logger.role = "logger";
  logger.state = process_status_t::READY;
  bus_.Subscribe<run_description_t>("HYDRO_RUN", [&, announced = false](const run_description_t&) mutable {
    if (!announced) bus_.Publish("HYDRO_PROCESS_STATUS", logger);
    announced = true;
  });
  // The controllers are announced after the logger, so that the plant knows it when the run starts.
  const settings::StackConfig config = SmallStack();
  SimulatedRig rig(config);
  PlantApp plant(bus_, clock_, config, rig, {"logger"});
  for (const char* role : {"pressure_ctrl", "position_ctrl"}) {
    process_status_t ready;
    ready.session = 1;
    ready.role = role;
    ready.state = process_status_t::READY;
    bus_.Publish("HYDRO_PROCESS_STATUS", ready);
  }
  EXPECT_EQ(plant.Run(), 1);
  EXPECT_THAT(plant.failure(), HasSubstr("logger has not answered"));
  EXPECT_LE(plant.tick(), 64);
}

// Tests that progress of a logger that was not there when the run began neither delays it nor is kept: each
// would be an entry that every tick examines.
TEST_F(PlantAppTest, LockstepIgnoresLoggersThatWereNotThere) {
  on_state_ = [this](const state_t& state) {
    for (int64_t i = 0; i < 10; ++i) {
      log_progress_t progress{};
      progress.session = 1000 + 10 * state.tick + i;
      progress.tick = state.tick;
      bus_.Publish("HYDRO_LOG_PROGRESS", progress);
    }
    if (state.tick % 5 == 0) SendPressureCommand(state.tick);
    SendVoltage(state.tick, 0);
  };
  EXPECT_EQ(Run(SmallStack()), 0) << failure_;
  EXPECT_EQ(states_.back().tick, 100);
}

// Tests that in real time, on exact simulated time, each tick is published and the newest command acts.
TEST_F(PlantAppTest, RealtimeTakesTheNewestCommand) {
  AnswerAll();
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  EXPECT_EQ(Run(config), 0);
  ASSERT_EQ(states_.size(), 101u);
  EXPECT_EQ(states_.back().skipped_ticks, 0);
  for (int64_t k = 2; k <= 100; ++k) EXPECT_EQ(states_[k].command_tick, k - 2);
  EXPECT_TRUE(faults_.empty());
}

// Tests that a late wake-up integrates the missed time under the held command: the state after a gap equals
// that of a run without the gap in which the same voltage was held, and says how many ticks were skipped.
TEST_F(PlantAppTest, LateWakeUpIntegratesWhatItMissed) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  config.time.duration_s = 0.05;
  config.last_tick = 50;
  const auto constant = [this](const state_t& s) { SendVoltage(s.tick, 1.5); };
  on_state_ = constant;
  ASSERT_EQ(Run(config), 0);
  const std::vector<state_t> even = std::move(states_);
  states_.clear();

  sequence_ = 0;
  bus::SimulatedClock late_clock;
  on_state_ = [&](const state_t& s) {
    constant(s);
    if (s.tick == 10) clock_.AdvanceTo(clock_.Now() + std::chrono::milliseconds(20));
  };
  clock_.AdvanceTo(clock_.Now() + std::chrono::seconds(1));
  ASSERT_EQ(Run(config), 0);
  ASSERT_LT(states_.size(), even.size());
  bool found = false;
  int64_t skipped = 0;
  for (const state_t& s : states_) {
    skipped += s.skipped_ticks;
    found = found || s.skipped_ticks > 0;
    EXPECT_NEAR(s.motor_speed, even[s.tick].motor_speed, 1e-6) << s.tick;
    EXPECT_NEAR(s.p2, even[s.tick].p2, 1e-4) << s.tick;
  }
  EXPECT_TRUE(found);
  EXPECT_EQ(skipped, 51 - static_cast<int64_t>(states_.size()));
}

// Tests that in real time a silent pressure loop gives zero volts and a named fault after the stale-input
// limit, and that the plant goes on and resumes when commands come again.
TEST_F(PlantAppTest, RealtimeStaleCommandGivesZeroVolts) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  config.limits.stale_input_s = 0.02;
  on_state_ = [this](const state_t& s) {
    if (s.tick < 30 || s.tick > 70) SendVoltage(s.tick, 1.5);
  };
  EXPECT_EQ(Run(config), 0);
  ASSERT_EQ(states_.size(), 101u);
  EXPECT_EQ(states_[49].voltage, 1.5);
  for (int64_t k = 54; k <= 70; ++k) EXPECT_EQ(states_[k].voltage, 0) << k;
  EXPECT_EQ(states_[60].command_tick, -1);
  EXPECT_EQ(states_[75].voltage, 1.5);
  ASSERT_EQ(faults_.size(), 2u);
  EXPECT_EQ(faults_[0].code, "stale_motor_command");
  EXPECT_TRUE(faults_[0].active);
  EXPECT_EQ(faults_[1].code, "stale_motor_command");
  EXPECT_FALSE(faults_[1].active);
}

// Tests that a pressure loop that was stopped and then works through piled-up states moves nothing with
// answers to states older than the stale-input limit, however many it sends.
TEST_F(PlantAppTest, RealtimeAnswersToOldStatesGiveZeroVolts) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  config.limits.stale_input_s = 0.02;
  on_state_ = [this](const state_t& s) {
    if (s.tick < 30) SendVoltage(s.tick, 1.5);
    if (s.tick >= 60 && s.tick < 80) SendVoltage(s.tick - 30, 9);
    if (s.tick >= 80) SendVoltage(s.tick, 1.5);
  };
  EXPECT_EQ(Run(config), 0);
  ASSERT_EQ(states_.size(), 101u);
  for (const state_t& s : states_) EXPECT_NE(s.voltage, 9) << s.tick;
  EXPECT_EQ(states_[70].voltage, 0);
  EXPECT_EQ(states_[85].voltage, 1.5);
  ASSERT_EQ(faults_.size(), 2u);
  EXPECT_EQ(faults_[0].code, "stale_motor_command");
  EXPECT_FALSE(faults_[1].active);
}

// Tests that a pressure loop slower than the stale-input limit is not called stale between its own samples,
// even when its answers come a tick late.
TEST_F(PlantAppTest, RealtimeSlowPressureLoopIsNotStale) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  config.limits.stale_input_s = 0.02;
  config.pressure_interval_ticks = 50;
  on_state_ = [this](const state_t& s) {
    if (s.tick % 50 == 1) SendVoltage(s.tick - 1, 1.5);
  };
  EXPECT_EQ(Run(config), 0);
  EXPECT_TRUE(faults_.empty());
  EXPECT_EQ(states_[40].voltage, 1.5);
}

// Tests that a command that is not finite acts as zero volts and is named.
TEST_F(PlantAppTest, NonFiniteCommandGivesZeroVolts) {
  settings::StackConfig config = SmallStack();
  on_state_ = [this](const state_t& s) {
    if (s.tick % 5 == 0) SendPressureCommand(s.tick);
    SendVoltage(s.tick, s.tick == 10 ? std::nan("") : 1.0);
  };
  EXPECT_EQ(Run(config), 0);
  EXPECT_EQ(states_[12].voltage, 0);
  EXPECT_EQ(states_[13].voltage, 1);
  ASSERT_EQ(faults_.size(), 2u);
  EXPECT_EQ(faults_[0].code, "nonfinite_motor_command");
}

// Tests that two senders of motor commands give zero volts and a named fault.
TEST_F(PlantAppTest, SecondCommandSenderGivesZeroVolts) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  on_state_ = [this](const state_t& s) {
    SendVoltage(s.tick, 1.0);
    if (s.tick == 20) SendVoltage(s.tick, 9.0, 99);
  };
  EXPECT_EQ(Run(config), 0);
  EXPECT_EQ(states_[20].voltage, 1);
  EXPECT_EQ(states_[22].voltage, 0);
  for (const state_t& s : states_) EXPECT_NE(s.voltage, 9) << s.tick;
  ASSERT_FALSE(faults_.empty());
  EXPECT_EQ(faults_[0].code, "second_motor_command_sender");
}

// Tests that what came while two sent does not act after one of them has gone, although in lockstep the tick
// waits so long.
TEST_F(PlantAppTest, CommandSentBesideAnotherNeverActs) {
  bus::Clock::TimePoint answered_from{};
  on_state_ = [&](const state_t& s) {
    if (s.tick == 5 && answered_from == bus::Clock::TimePoint{}) {
      answered_from = clock_.Now() + std::chrono::milliseconds(300);
      SendVoltage(5, 9.0, 99);
    }
    SendVoltage(s.tick, 1.0);
    if (s.tick % 5 == 0 && (s.tick != 5 || clock_.Now() > answered_from)) SendPressureCommand(s.tick);
  };
  // Tick 5 is repeated, and with it the command: the first one came beside the other sender's.
  EXPECT_EQ(Run(SmallStack()), 0);
  ASSERT_EQ(states_.back().tick, 100);
  for (const state_t& s : states_) EXPECT_NE(s.command_tick, 5) << s.tick;
  EXPECT_EQ(states_.back().voltage, 1);
}

// Tests that in lockstep, too, senders that come in turn are named, although each has been silent for long
// when the tick is checked.
TEST_F(PlantAppTest, SendersInTurnAreNamed) {
  on_state_ = [&](const state_t& s) {
    if (s.tick % 5 == 0) SendPressureCommand(s.tick);
    SendVoltage(s.tick, 1.0, std::max<int64_t>(s.tick, 20));
  };
  EXPECT_EQ(Run(SmallStack()), 0);
  ASSERT_EQ(states_.back().tick, 100);
  for (const state_t& s : states_) EXPECT_EQ(s.voltage, s.tick < 2 || s.tick > 21 ? 0 : 1) << s.tick;
  ASSERT_FALSE(faults_.empty());
  EXPECT_EQ(faults_[0].code, "second_motor_command_sender");
  EXPECT_THAT(faults_[0].text, HasSubstr("session 20"));
  EXPECT_THAT(faults_[0].text, HasSubstr("session 21"));
}

// Tests that a command from the future, as a played log would send, is refused.
TEST_F(PlantAppTest, FutureCommandIsRefused) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  on_state_ = [this](const state_t& s) { SendVoltage(s.tick + 1000, 5); };
  Run(config);
  for (const state_t& s : states_) EXPECT_EQ(s.voltage, 0);
  ASSERT_FALSE(faults_.empty());
  EXPECT_EQ(faults_[0].code, "future_motor_command");
}

// Tests that a command from the future also ends what acted before it, until a sensible command comes.
TEST_F(PlantAppTest, FutureCommandGivesZeroVolts) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  on_state_ = [this](const state_t& s) {
    const bool future = s.tick >= 10 && s.tick < 20;
    SendVoltage(future ? s.tick + 1 : s.tick, 1.5);
  };
  EXPECT_EQ(Run(config), 0);
  EXPECT_EQ(states_[10].voltage, 1.5);
  for (int64_t k = 13; k <= 20; ++k) EXPECT_EQ(states_[k].voltage, 0) << k;
  EXPECT_EQ(states_[25].voltage, 1.5);
  ASSERT_EQ(faults_.size(), 2u);
  EXPECT_EQ(faults_[0].code, "future_motor_command");
  EXPECT_FALSE(faults_[1].active);
}

// Tests that an arm that leaves its volume ends the run with an error that names the angle.
TEST_F(PlantAppTest, ModelErrorEndsTheRun) {
  settings::StackConfig config = SmallStack();
  config.model.arm_angle_rad = 0.84;
  config.last_tick = 20000;
  on_state_ = [this](const state_t& s) {
    if (s.tick % 5 == 0) SendPressureCommand(s.tick);
    SendVoltage(s.tick, 10);
  };
  EXPECT_EQ(Run(config), 1);
  EXPECT_THAT(failure_, HasSubstr("angle"));
  ASSERT_FALSE(faults_.empty());
  EXPECT_EQ(faults_.back().code, "model_error");
  EXPECT_LT(states_.back().tick, 20000);
}

// Tests that where a plant has slept while the held voltage drove the arm through its limit and out of its
// volume, the limit is named, with the angle, and not the model.
TEST_F(PlantAppTest, SleepingThroughALimitNamesTheLimit) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  config.model.arm_angle_rad = 0.7;
  config.limits.arm_angle_rad = 0.8;
  config.last_tick = 20000;
  on_state_ = [this](const state_t& s) {
    if (s.tick % 5 == 0) SendPressureCommand(s.tick);
    SendVoltage(s.tick, 10);
    if (s.tick == 50) clock_.AdvanceTo(clock_.Now() + std::chrono::seconds(5));
  };
  EXPECT_EQ(Run(config), 1);
  ASSERT_FALSE(faults_.empty());
  EXPECT_EQ(faults_.back().code, "arm_angle_limit");
  EXPECT_TRUE(faults_.back().latched);
  EXPECT_GT(faults_.back().value, 0.8);
  EXPECT_EQ(faults_.back().limit, 0.8);
  EXPECT_THAT(failure_, HasSubstr("allowed is |alpha| <= 0.8 rad (limits.arm_angle)"));
}

// Tests that a configuration with an arm angle that the model cannot have is bad input, not a failed run.
TEST_F(PlantAppTest, ImpossibleAngleIsBadInput) {
  settings::StackConfig config = SmallStack();
  config.model.arm_angle_rad = 1.5708;
  EXPECT_THROW(SimulatedRig{config}, InputError);
}

}  // namespace
}  // namespace hydro::plant
