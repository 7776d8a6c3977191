#include "pressure_ctrl/pressure_app.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <hydro/fault_t.hpp>
#include <limits>
#include <vector>

#include "bus/in_process_bus.h"
#include "tests/stack_fixture.h"
#include "tune/live/tuned_values.h"

namespace hydro::pressure_ctrl {
namespace {

using ::testing::ElementsAre;
using testing::SmallStack;
using namespace std::chrono_literals;

// The pressure loop on an in-process bus; the test plays plant and position loop.
class PressureAppTest : public ::testing::Test {
 protected:
  void Start(const settings::StackConfig& config, OwnPressureLaw own = {}) {
    app_ = std::make_unique<PressureApp>(bus_, clock_, config, std::move(own));
    bus_.Subscribe<motor_command_t>("HYDRO_MOTOR_COMMAND",
                                    [this](const motor_command_t& c) { commands_.push_back(c); });
    bus_.Subscribe<fault_t>("HYDRO_FAULT", [this](const fault_t& f) { faults_.push_back(f); });
    bus_.Subscribe<stop_t>("HYDRO_STOP", [this](const stop_t& s) { stops_.push_back(s); });
    Deliver();
  }

  void Deliver() {
    while (bus_.HandleUntil(clock_.Now()) > 0) {
    }
  }

  state_t State(int64_t tick) {
    state_t s{};
    s.tick = tick;
    s.session = plant_session_;
    s.sequence = tick;
    s.p1 = 100;
    s.p2 = 200;
    s.motor_speed = 5;
    return s;
  }

  void SendState(const state_t& s) {
    bus_.Publish("HYDRO_STATE", s);
    Deliver();
  }

  void SendPressure(int64_t tick, double pressure_ref, int64_t sequence) {
    pressure_command_t c{};
    c.tick = tick;
    c.session = 7;
    c.sequence = sequence;
    c.pressure_ref = pressure_ref;
    bus_.Publish("HYDRO_PRESSURE_COMMAND", c);
    Deliver();
  }

  void SendPressure(int64_t tick, double pressure_ref) { SendPressure(tick, pressure_ref, tick); }

  static double Law(double pressure_ref) { return 0.125 * ((pressure_ref - 100) - 8 * 5); }

  bus::SimulatedClock clock_;
  bus::InProcessBus bus_{&clock_};
  std::unique_ptr<PressureApp> app_;
  std::vector<motor_command_t> commands_;
  std::vector<fault_t> faults_;
  std::vector<stop_t> stops_;
  int64_t plant_session_ = 3;
};

// Tests that a command for a tick that never comes, received before the first state, when nobody can tell,
// does not hold up all others.
TEST_F(PressureAppTest, FarCommandBeforeTheFirstState) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  Start(config);
  SendPressure(int64_t{1} << 62, 77, -1);
  SendState(State(0));
  SendPressure(0, 50);
  SendState(State(1));
  SendState(State(2));
  ASSERT_FALSE(commands_.empty());
  EXPECT_EQ(commands_.back().pressure_command_tick, 0);
  EXPECT_EQ(commands_.back().pressure_ref, 50);
}

// Tests that each tick gets one command, and that the pressure command computed from tick 0 acts from tick 1
// on.
TEST_F(PressureAppTest, PressureCommandActsOneTickLater) {
  Start(SmallStack());
  SendState(State(0));
  SendPressure(0, 120);
  SendState(State(1));
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_EQ(commands_[0].tick, 0);
  EXPECT_EQ(commands_[0].pressure_command_tick, -1);
  EXPECT_DOUBLE_EQ(commands_[0].voltage, std::max(-10.0, Law(0)));
  EXPECT_EQ(commands_[1].tick, 1);
  EXPECT_EQ(commands_[1].pressure_command_tick, 0);
  EXPECT_DOUBLE_EQ(commands_[1].voltage, Law(120));
  EXPECT_EQ(commands_[1].status, motor_command_t::LAW);
}

// Tests that with no command delay the loop waits, in lockstep, for the pressure command of the same tick.
TEST_F(PressureAppTest, WithoutDelayTheSameTicksPressureCommandActs) {
  settings::StackConfig config = SmallStack();
  config.plant.command_delay_ticks = 0;
  Start(config);
  SendState(State(0));
  EXPECT_TRUE(commands_.empty());
  SendPressure(0, 120);
  ASSERT_EQ(commands_.size(), 1u);
  EXPECT_DOUBLE_EQ(commands_[0].voltage, Law(120));
}

// Tests that a due pressure command that arrives after its state (another route through a network) changes
// nothing.
TEST_F(PressureAppTest, LockstepResultDoesNotDependOnArrivalOrder) {
  Start(SmallStack());
  SendState(State(0));
  SendState(State(1));
  EXPECT_EQ(commands_.size(), 1u);  // tick 1 waits for the pressure command of tick 0
  SendPressure(0, 120);
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_DOUBLE_EQ(commands_[1].voltage, Law(120));
}

// Tests that an early pressure command is not used early.
TEST_F(PressureAppTest, EarlyPressureCommandWaits) {
  Start(SmallStack());
  SendPressure(0, 120);
  SendState(State(0));
  ASSERT_EQ(commands_.size(), 1u);
  EXPECT_EQ(commands_[0].pressure_command_tick, -1);
}

// Tests that a resent state gets the same answer again, bit for bit.
TEST_F(PressureAppTest, RepeatsTheAnswerToARepeatedState) {
  Start(SmallStack());
  SendState(State(0));
  SendState(State(0));
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_EQ(commands_[0].voltage, commands_[1].voltage);
  EXPECT_EQ(commands_[0].sequence, commands_[1].sequence);
}

// Tests that each non-finite measurement gives zero volts and a fault that ends when the measurement is good
// again.
TEST_F(PressureAppTest, NonFiniteStateGivesZeroVolts) {
  Start(SmallStack());
  SendState(State(0));
  SendPressure(0, 120);
  int64_t tick = 1;
  for (double state_t::*field : {&state_t::p1, &state_t::p2, &state_t::motor_speed}) {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      if (bad > 0 && field != &state_t::motor_speed)
        continue;  // an infinite pressure is above the limit: latched
      state_t s = State(tick++);
      s.*field = bad;
      faults_.clear();
      SendState(s);
      EXPECT_EQ(commands_.back().voltage, 0);
      EXPECT_EQ(commands_.back().status, motor_command_t::SAFE);
      ASSERT_EQ(faults_.size(), 1u);
      EXPECT_EQ(faults_[0].code, "nonfinite_state");
      EXPECT_TRUE(faults_[0].active);
      SendState(State(tick++));
      EXPECT_EQ(commands_.back().status, motor_command_t::LAW);
      ASSERT_EQ(faults_.size(), 2u);
      EXPECT_FALSE(faults_[1].active);
      if (tick == 5) SendPressure(5, 120);
    }
  }
  EXPECT_TRUE(stops_.empty());
}

// Tests that gains whose products overflow give zero volts and a fault, never a voltage that is not a number.
TEST_F(PressureAppTest, OverflowOfTheLawGivesZeroVolts) {
  settings::StackConfig config = SmallStack();
  config.pressure.k_p = 1e300;
  config.pressure.k_v = 1e300;
  config.pressure.reference_feedforward_V_psi = 1e308;
  Start(config);
  SendState(State(0));
  SendPressure(0, 120);
  SendState(State(1));
  EXPECT_EQ(commands_.back().voltage, 0);
  EXPECT_EQ(commands_.back().status, motor_command_t::SAFE);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "nonfinite_motor_command");
  EXPECT_TRUE(faults_[0].active);
}

// Tests that a law of the user's own gets the state and the reference in force, that its voltage is cut to
// the limit, and that one that is not a number gives zero volts and a fault.
TEST_F(PressureAppTest, RunsALawOfTheUsersOwn) {
  const settings::StackConfig config = SmallStack();
  const double limit = tuning::ValuesOf(config).pressure.voltage_limit;
  double scale = 0.01;
  Start(config, [&](const state_t& state, double pressure_ref) {
    return scale * (pressure_ref - (state.p2 - state.p1));
  });
  SendState(State(0));
  SendPressure(0, 120);
  SendState(State(1));
  EXPECT_DOUBLE_EQ(commands_.back().voltage, 0.01 * (120 - 100));
  EXPECT_EQ(commands_.back().status, motor_command_t::LAW);
  EXPECT_FALSE(commands_.back().saturated);
  scale = 1e6;
  SendState(State(2));
  EXPECT_EQ(commands_.back().voltage, limit);
  EXPECT_TRUE(commands_.back().saturated);
  scale = NAN;
  SendState(State(3));
  EXPECT_EQ(commands_.back().voltage, 0);
  EXPECT_EQ(commands_.back().status, motor_command_t::SAFE);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "nonfinite_motor_command");
}

// Tests that a running loop announces itself again to a restarted plant that is looking for it.
TEST_F(PressureAppTest, AnswersTheRollCallOfARestartedPlant) {
  Start(SmallStack());
  int announcements = 0;
  bus_.Subscribe<process_status_t>("HYDRO_PROCESS_STATUS", [&](const process_status_t& s) {
    announcements += s.role == "pressure_ctrl" && s.state == process_status_t::RUNNING;
  });
  SendState(State(0));
  EXPECT_EQ(announcements, 1);
  process_status_t plant;
  plant.role = "plant";
  plant.session = plant_session_ + 1;
  plant.state = process_status_t::READY;
  bus_.Publish("HYDRO_PROCESS_STATUS", plant);
  Deliver();
  EXPECT_EQ(announcements, 2);
}

class PressureLimitTest : public PressureAppTest, public ::testing::WithParamInterface<double state_t::*> {};

// Tests that a pressure above the limit, on either side, trips: zero volts for good, one fault, the end of
// the run.
TEST_P(PressureLimitTest, Trips) {
  Start(SmallStack());
  SendState(State(0));
  SendPressure(0, 120);
  state_t s = State(1);
  s.*GetParam() = 2000.5;
  SendState(s);
  EXPECT_EQ(commands_.back().voltage, 0);
  EXPECT_EQ(commands_.back().status, motor_command_t::SAFE);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "pressure_limit");
  EXPECT_TRUE(faults_[0].latched);
  EXPECT_EQ(faults_[0].value, 2000.5);
  EXPECT_EQ(faults_[0].limit, 2000);
  SendState(State(2));
  EXPECT_EQ(commands_.back().voltage, 0);
  ASSERT_EQ(stops_.size(), 1u);
  EXPECT_EQ(stops_[0].exit_code, 1);
  EXPECT_TRUE(app_->finished());
  EXPECT_EQ(app_->Finish(), 1);
}

INSTANTIATE_TEST_SUITE_P(BothSides, PressureLimitTest, ::testing::Values(&state_t::p1, &state_t::p2));

// Tests that in real time the last reference of a silent position loop is held for the stale-input limit and
// falls linearly to zero within limits.pressure_ramp_s, and that the voltage is then zero: all counted in
// ticks, so that a replay does the same. The loop resumes with the next pressure command.
TEST_F(PressureAppTest, StalePressureReferenceGoesToZeroThenTheVoltage) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  config.limits.stale_input_s = 0.02;  // 20 ticks, beside one sample interval of 5 and the delay of 1
  config.limits.pressure_ramp_s = 0.01;
  Start(config);
  SendPressure(0, 120);
  for (int64_t tick = 0; tick <= 40; ++tick) SendState(State(tick));
  ASSERT_EQ(commands_.size(), 41u);
  for (int64_t tick = 1; tick <= 40; ++tick) {
    const motor_command_t& c = commands_[tick];
    const double reference = tick <= 26  ? 120
                             : tick < 36 ? 120 * (1 - 0.1 * static_cast<double>(tick - 26))
                                         : 0;
    EXPECT_NEAR(c.pressure_ref, reference, 1e-12) << tick;
    EXPECT_EQ(c.status, tick < 36 ? motor_command_t::LAW : motor_command_t::SAFE) << tick;
    EXPECT_NEAR(c.voltage, tick < 36 ? std::max(-10.0, Law(reference)) : 0, 1e-12) << tick;
  }
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "stale_pressure_command");
  EXPECT_EQ(faults_[0].tick, 27);
  SendPressure(40, 120);
  SendState(State(41));
  EXPECT_EQ(commands_.back().status, motor_command_t::LAW);
  EXPECT_EQ(commands_.back().pressure_ref, 120);
  EXPECT_EQ(faults_.size(), 2u);
}

// Tests that without a ramp, and for an open-loop voltage, which cannot be ramped, zero volts come at once.
TEST_F(PressureAppTest, StaleVoltageGivesZeroVolts) {
  for (const bool open_loop : {false, true}) {
    clock_ = bus::SimulatedClock();
    bus::InProcessBus bus(&clock_);
    settings::StackConfig config = SmallStack();
    config.time.mode = settings::TimeMode::kRealtime;
    config.limits.stale_input_s = 0.02;
    config.limits.pressure_ramp_s = open_loop ? 0.2 : 0;
    PressureApp app(bus, clock_, config);
    std::vector<motor_command_t> commands;
    bus.Subscribe<motor_command_t>("HYDRO_MOTOR_COMMAND",
                                   [&](const motor_command_t& c) { commands.push_back(c); });
    pressure_command_t command{};
    command.open_loop = open_loop;
    command.voltage = 2.5;
    command.pressure_ref = 120;
    bus.Publish("HYDRO_PRESSURE_COMMAND", command);
    for (int64_t tick = 0; tick <= 40; ++tick) bus.Publish("HYDRO_STATE", State(tick));
    while (bus.HandleUntil(clock_.Now()) > 0) {
    }
    ASSERT_EQ(commands.size(), 41u);
    EXPECT_NE(commands[26].status, motor_command_t::SAFE);
    for (int64_t tick = 27; tick <= 40; ++tick) {
      EXPECT_EQ(commands[tick].status, motor_command_t::SAFE) << tick;
      EXPECT_EQ(commands[tick].voltage, 0) << tick;
    }
  }
}

// Tests that a reference beyond what limits.arm_torque_in_lbf allows is not followed, while one at the limit
// is, plus half a step of the D/A converter.
TEST_F(PressureAppTest, ExcessivePressureReferenceGivesZeroVolts) {
  settings::StackConfig config = SmallStack();
  config.limits.arm_torque_in_lbf = 368;  // 100 psi
  config.position.dac_bits = 12;
  config.position.dac_range_psi = 2048;  // steps of 1 psi
  Start(config);
  SendState(State(0));
  int64_t tick = 0;
  for (const double reference : {100.5, -100.5, 100.6, -100.6, 100.0}) {
    SendPressure(tick, reference);
    for (int k = 0; k < 5; ++k) SendState(State(++tick));
    const bool allowed = std::fabs(reference) <= 100.5;
    EXPECT_EQ(commands_.back().status, allowed ? motor_command_t::LAW : motor_command_t::SAFE) << reference;
    if (!allowed) {
      EXPECT_EQ(commands_.back().voltage, 0);
    }
  }
  ASSERT_EQ(faults_.size(), 2u);
  EXPECT_EQ(faults_[0].code, "excessive_pressure_command");
  EXPECT_EQ(faults_[0].value, 100.6);
  EXPECT_FALSE(faults_[1].active);
}

// Tests that a command for a tick far in the future is refused, zeroes the voltage, and does not delay what
// comes after it.
TEST_F(PressureAppTest, FuturePressureCommandGivesZeroVolts) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  config.limits.stale_input_s = 0.02;
  Start(config);
  SendPressure(0, 120);
  SendState(State(0));
  pressure_command_t future{};
  future.tick = 1000;
  future.session = 7;
  future.sequence = 1;
  future.pressure_ref = 300;
  bus_.Publish("HYDRO_PRESSURE_COMMAND", future);
  SendState(State(1));
  EXPECT_EQ(commands_.back().status, motor_command_t::SAFE);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "future_pressure_command");
  EXPECT_EQ(faults_[0].value, 1000);
  SendPressure(5, 130);  // ahead by what a network may do
  SendState(State(2));
  EXPECT_EQ(commands_.back().status, motor_command_t::LAW);
  EXPECT_EQ(commands_.back().pressure_ref, 120);
  for (int64_t tick = 3; tick <= 6; ++tick) SendState(State(tick));
  EXPECT_EQ(commands_.back().pressure_ref, 130);
  EXPECT_FALSE(faults_.back().active);
}

// Tests that it is told even where a plausible command has come before the next state.
TEST_F(PressureAppTest, FuturePressureCommandBesideAGoodOneIsTold) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  Start(config);
  SendPressure(0, 120);
  SendState(State(0));
  SendPressure(1000, 300);
  SendPressure(0, 120, 1);
  SendState(State(1));
  EXPECT_EQ(commands_.back().status, motor_command_t::SAFE);
  SendPressure(1, 120, 2);
  SendState(State(2));
  EXPECT_EQ(commands_.back().status, motor_command_t::LAW);
  ASSERT_EQ(faults_.size(), 2u);
  EXPECT_EQ(faults_[0].code, "future_pressure_command");
  EXPECT_FALSE(faults_[1].active);
}

// Tests that an arm beyond its limit trips as a pressure does.
TEST_F(PressureAppTest, ArmAngleLimitTrips) {
  settings::StackConfig config = SmallStack();
  config.limits.arm_angle_rad = 0.8;
  Start(config);
  state_t s = State(0);
  s.arm_angle = -0.81;
  SendState(s);
  EXPECT_EQ(commands_.back().status, motor_command_t::SAFE);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "arm_angle_limit");
  EXPECT_EQ(faults_[0].value, 0.81);
  EXPECT_TRUE(faults_[0].latched);
  EXPECT_TRUE(app_->finished());
}

// Tests that with limits.rearm = "explicit" (the plant then holds the voltage at zero) this loop goes on and
// ends the fault when the limit is respected again.
TEST_F(PressureAppTest, ExplicitRearmEndsNothingHere) {
  settings::StackConfig config = SmallStack();
  config.limits.rearm = settings::Rearm::kExplicit;
  Start(config);
  SendState(State(0));
  SendPressure(0, 120);
  state_t s = State(1);
  s.p1 = 2000.5;
  SendState(s);
  EXPECT_EQ(commands_.back().status, motor_command_t::SAFE);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_FALSE(faults_[0].latched);
  EXPECT_FALSE(app_->finished());
  SendState(State(2));
  EXPECT_EQ(commands_.back().status, motor_command_t::LAW);
  ASSERT_EQ(faults_.size(), 2u);
  EXPECT_FALSE(faults_[1].active);
  EXPECT_TRUE(stops_.empty());
}

// Tests that a noisy pressure on its way back through its limit raises its fault once, and that the fault
// ends well below the limit.
TEST_F(PressureAppTest, NoiseAtALimitIsOneFault) {
  settings::StackConfig config = SmallStack();
  config.limits.rearm = settings::Rearm::kExplicit;
  Start(config);
  SendState(State(0));
  SendPressure(0, 120);
  int64_t tick = 1;
  for (const double p1 : {2000.5, 1999.5, 2000.1, 1901.0}) {
    state_t s = State(tick++);
    s.p1 = p1;
    SendState(s);
    EXPECT_EQ(commands_.back().status, motor_command_t::SAFE) << p1;
  }
  ASSERT_EQ(faults_.size(), 1u);
  state_t s = State(tick++);
  s.p1 = 1899;
  SendState(s);
  EXPECT_EQ(commands_.back().status, motor_command_t::LAW);
  ASSERT_EQ(faults_.size(), 2u);
  EXPECT_FALSE(faults_[1].active);
  // Without a fault the whole range up to the limit is allowed.
  s = State(tick++);
  s.p1 = 1999.5;
  SendState(s);
  EXPECT_EQ(commands_.back().status, motor_command_t::LAW);
  EXPECT_EQ(faults_.size(), 2u);
}

// Tests that in real time a silent plant gives first a zero-volt command, then a fault.
TEST_F(PressureAppTest, StaleStateGivesZeroVolts) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  Start(config);
  SendState(State(0));
  clock_.AdvanceTo(clock_.Now() + 99ms);
  app_->Poll();
  Deliver();
  EXPECT_EQ(commands_.size(), 1u);
  clock_.AdvanceTo(clock_.Now() + 2ms);
  app_->Poll();
  app_->Poll();
  Deliver();
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_EQ(commands_[1].voltage, 0);
  EXPECT_EQ(commands_[1].status, motor_command_t::SAFE);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "stale_state");
  SendState(State(1));
  EXPECT_EQ(commands_.back().status, motor_command_t::LAW);
  EXPECT_FALSE(faults_.back().active);
}

// Tests that in lockstep a silent plant ends this process with an error that names it, in less than 2 s.
TEST_F(PressureAppTest, LockstepEndsWhenThePlantStalls) {
  Start(SmallStack());
  SendState(State(0));
  for (int i = 0; i < 95; ++i) {
    EXPECT_FALSE(app_->finished());
    clock_.AdvanceTo(clock_.Now() + 20ms);
    app_->Poll();
  }
  clock_.AdvanceTo(clock_.Now() + 20ms);
  app_->Poll();
  Deliver();
  ASSERT_TRUE(app_->finished());
  ASSERT_EQ(stops_.size(), 1u);
  EXPECT_THAT(stops_[0].reason, ::testing::HasSubstr("plant"));
  EXPECT_EQ(app_->Finish(), 1);
}

// Tests that two plants on one network give zero volts and a named fault while the second is heard.
TEST_F(PressureAppTest, SecondStateSenderGivesZeroVolts) {
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  Start(config);
  SendState(State(0));
  plant_session_ = 4;
  SendState(State(0));
  plant_session_ = 3;
  SendState(State(1));
  EXPECT_EQ(commands_.back().voltage, 0);
  EXPECT_EQ(commands_.back().status, motor_command_t::SAFE);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "second_state_sender");
}

// Tests that an open-loop command passes its voltage through, limited to what the amplifier takes.
TEST_F(PressureAppTest, OpenLoopPassesVoltageThrough) {
  Start(SmallStack());
  pressure_command_t c{};
  c.open_loop = true;
  c.voltage = 2.5;
  bus_.Publish("HYDRO_PRESSURE_COMMAND", c);
  SendState(State(0));
  SendState(State(1));
  EXPECT_EQ(commands_.back().voltage, 2.5);
  EXPECT_EQ(commands_.back().status, motor_command_t::OPEN_LOOP);
}

// Tests that the last command of a run is zero volts, whatever came before.
TEST_F(PressureAppTest, FinishesWithZeroVolts) {
  Start(SmallStack());
  SendState(State(0));
  stop_t stop{};
  bus_.Publish("HYDRO_STOP", stop);
  Deliver();
  EXPECT_TRUE(app_->finished());
  EXPECT_EQ(app_->Finish(), 0);
  Deliver();
  EXPECT_EQ(commands_.back().voltage, 0);
  EXPECT_EQ(commands_.back().status, motor_command_t::STOPPED);
}

// Tests that a loop slower than the plant acts on its own multiples only.
TEST_F(PressureAppTest, ActsOnItsOwnMultiples) {
  settings::StackConfig config = SmallStack();
  config.pressure_interval_ticks = 2;
  Start(config);
  SendPressure(0, 120);
  for (int64_t tick = 0; tick < 5; ++tick) SendState(State(tick));
  std::vector<int64_t> ticks;
  for (const motor_command_t& c : commands_) ticks.push_back(c.tick);
  EXPECT_THAT(ticks, ElementsAre(0, 2, 4));
}

}  // namespace
}  // namespace hydro::pressure_ctrl
