#include "position_ctrl/position_app.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <hydro/fault_t.hpp>
#include <vector>

#include "bus/in_process_bus.h"
#include "position_ctrl/law/position_law.h"
#include "tests/stack_fixture.h"
#include "tune/live/tuned_values.h"

namespace hydro::position_ctrl {
namespace {

using ::testing::ElementsAre;
using testing::SmallStack;
using namespace std::chrono_literals;

// The position loop on an in-process bus; the test plays the plant.
class PositionAppTest : public ::testing::Test {
 protected:
  void Start(const settings::StackConfig& config) {
    app_ = std::make_unique<PositionApp>(bus_, clock_, config);
    bus_.Subscribe<pressure_command_t>("HYDRO_PRESSURE_COMMAND",
                                       [this](const pressure_command_t& c) { commands_.push_back(c); });
    bus_.Subscribe<arm_reference_t>("HYDRO_ARM_REFERENCE",
                                    [this](const arm_reference_t& r) { references_.push_back(r); });
    bus_.Subscribe<fault_t>("HYDRO_FAULT", [this](const fault_t& f) { faults_.push_back(f); });
    Deliver();
  }

  void Deliver() {
    while (bus_.HandleUntil(clock_.Now()) > 0) {
    }
  }

  void SendState(int64_t tick, double arm_angle, int64_t command_tick = 0) {
    state_t s{};
    s.command_tick = command_tick;
    s.tick = tick;
    s.session = 3;
    s.sequence = tick;
    s.time = 1e-3 * static_cast<double>(tick);
    s.arm_angle = arm_angle;
    bus_.Publish("HYDRO_STATE", s);
    Deliver();
  }

  // The plant says which values are in force.
  void SendSettings(int64_t version, const std::function<void(tuning::TunedValues&)>& change = {}) {
    tuning::TunedValues values = tuning::ValuesOf(SmallStack());
    if (change) change(values);
    tuned_settings_t settings{};
    settings.session = 3;
    settings.version = version;
    settings.stage = tuned_settings_t::IN_FORCE;
    tuning::Write(values, &settings);
    bus_.Publish("HYDRO_SETTINGS", settings);
    Deliver();
  }

  static settings::StackConfig WithReference(settings::ReferenceSignal signal, double value) {
    settings::StackConfig config = SmallStack();
    config.reference.signal = signal;
    config.reference.trajectory.initial = 0;
    config.reference.trajectory.steps = {{0.005, value}};
    return config;
  }

  // Stands still until it is advanced, and may pass for a clock of the machine.
  class TestClock : public bus::SimulatedClock {
   public:
    bool simulated() const override { return simulated_; }
    bool simulated_ = true;
  };

  TestClock clock_;
  bus::InProcessBus bus_{&clock_};
  std::unique_ptr<PositionApp> app_;
  std::vector<pressure_command_t> commands_;
  std::vector<arm_reference_t> references_;
  std::vector<fault_t> faults_;
};

// Tests that exactly the ticks that are multiples of the sample interval get a command, with its reference.
TEST_F(PositionAppTest, ActsEveryNthTick) {
  Start(WithReference(settings::ReferenceSignal::kArmAngle, 0.1));
  for (int64_t tick = 0; tick <= 12; ++tick) SendState(tick, 0);
  std::vector<int64_t> ticks;
  for (const auto& c : commands_) ticks.push_back(c.tick);
  EXPECT_THAT(ticks, ElementsAre(0, 5, 10));
  ASSERT_EQ(references_.size(), 3u);
  EXPECT_EQ(references_[0].value, 0);
  EXPECT_EQ(references_[1].value, 0.1);
  EXPECT_EQ(references_[1].signal, arm_reference_t::ARM_ANGLE);
}

// Tests eq. (17) through the messages: c1 = 1000, c2 = 30, T = 5 ms, derivative on the measurement.
TEST_F(PositionAppTest, AppliesEquation17) {
  Start(WithReference(settings::ReferenceSignal::kArmAngle, 0.1));
  SendState(0, 0.001);
  SendState(5, 0.002);
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_DOUBLE_EQ(commands_[0].pressure_ref, -1000 * 0.001);
  EXPECT_DOUBLE_EQ(commands_[1].pressure_ref, -1000 * (0.002 - 0.1) - 30 / 0.005 * 0.001);
  EXPECT_FALSE(commands_[1].open_loop);
}

// Tests that after zero volts the reference starts from where the arm is and comes back in return_s, and that
// the start of a run, when no command is in force yet, is no such case.
TEST_F(PositionAppTest, ReferenceReturnsWithoutAJump) {
  settings::StackConfig config = WithReference(settings::ReferenceSignal::kArmAngle, 0.1);
  config.limits.return_s = 0.02;
  Start(config);
  SendState(0, 0, -1);
  SendState(5, 0.02);
  for (int64_t tick = 6; tick < 20; ++tick) SendState(tick, 0.04, -1);
  for (int64_t tick = 20; tick <= 45; ++tick) SendState(tick, 0.04);
  std::vector<double> values;
  for (const arm_reference_t& r : references_) values.push_back(r.value);
  ASSERT_EQ(values.size(), 10u);
  EXPECT_THAT(values, ElementsAre(0, 0.1, 0.04, 0.04, 0.04, ::testing::DoubleEq(0.055),
                                  ::testing::DoubleEq(0.07), ::testing::DoubleEq(0.085), 0.1, 0.1));
}

// Tests that a hold that falls between two samples starts from where the arm is as well.
TEST_F(PositionAppTest, ShortHoldDoesNotJump) {
  settings::StackConfig config = WithReference(settings::ReferenceSignal::kArmAngle, 0.1);
  config.limits.return_s = 0.02;
  Start(config);
  for (int64_t tick = 0; tick <= 10; ++tick) SendState(tick, 0.09);
  SendState(11, 0.09);
  SendState(12, 0.09, -1);
  for (int64_t tick = 13; tick <= 20; ++tick) SendState(tick, 0.09);
  ASSERT_EQ(references_.size(), 5u);
  EXPECT_NEAR(references_[3].value, 0.09, 0.002);
  EXPECT_NEAR(references_[4].value, 0.09, 0.004);
}

// Tests that a loop that joins a run which has gone on without it, and one whose pressure loop reports a
// fault that zeroes the voltage, start from where the arm is.
TEST_F(PositionAppTest, JoiningAndSafeOutputDoNotJump) {
  settings::StackConfig config = WithReference(settings::ReferenceSignal::kArmAngle, 0.1);
  config.time.mode = settings::TimeMode::kRealtime;
  config.limits.return_s = 0.02;
  clock_.simulated_ = false;
  Start(config);
  SendState(999, 0.05);
  EXPECT_TRUE(references_.empty()) << "it does not know yet which values are in force";
  SendSettings(0);
  SendState(1000, 0.05);
  for (int64_t tick = 1001; tick <= 1030; ++tick) SendState(tick, 0.05);
  EXPECT_NEAR(references_.front().value, 0.05, 1e-9);
  EXPECT_EQ(references_.back().value, 0.1);
  fault_t fault{};
  fault.session = 9;
  fault.source = "pressure_ctrl";
  fault.code = "stale_pressure_command";
  fault.active = true;
  bus_.Publish("HYDRO_FAULT", fault);
  Deliver();
  SendState(1035, 0.02);
  EXPECT_EQ(references_.back().value, 0.02);
  fault.active = false;
  bus_.Publish("HYDRO_FAULT", fault);
  Deliver();
  SendState(1036, 0.02);
  SendState(1040, 0.02);
  EXPECT_NEAR(references_.back().value, 0.02 + 0.08 * 4 / 20, 1e-9);
}

// Tests that a loop that joins a run acts by the values in force there, from its first command on.
TEST_F(PositionAppTest, ActsByTheValuesInForceWhenItJoins) {
  settings::StackConfig config = WithReference(settings::ReferenceSignal::kArmAngle, 0.1);
  config.time.mode = settings::TimeMode::kRealtime;
  config.limits.return_s = 0;
  clock_.simulated_ = false;
  Start(config);
  SendState(1000, 0.05);
  EXPECT_TRUE(commands_.empty());
  SendSettings(4, [](tuning::TunedValues& values) { values.position.c1 = 2000; });
  SendState(1005, 0.05);
  ASSERT_EQ(commands_.size(), 1u);
  EXPECT_DOUBLE_EQ(commands_[0].pressure_ref, 2000 * 0.05);
}

arm_plan_t Plan(int64_t sequence, int64_t tick, const std::vector<double>& time,
                const std::vector<double>& angle) {
  arm_plan_t plan;
  plan.session = 8;
  plan.sequence = sequence;
  plan.tick = tick;
  plan.count = static_cast<int32_t>(time.size());
  plan.time = time;
  plan.arm_angle = angle;
  plan.arm_speed.assign(time.size(), 0);
  plan.torque.assign(time.size(), 0);
  return plan;
}

class PlannerTest : public PositionAppTest {
 protected:
  void StartPlanned() {
    settings::StackConfig config = WithReference(settings::ReferenceSignal::kArmAngle, 0);
    config.reference.trajectory.kind = settings::TrajectorySpec::Kind::kPlanner;
    config.reference.trajectory.initial = 0.02;
    config.reference.trajectory.timeout_s = 0.03;
    config.limits.arm_angle_rad = 0.5;
    Start(config);
  }

  void Send(const arm_plan_t& plan) {
    bus_.Publish("HYDRO_ARM_PLAN", plan);
    Deliver();
  }
};

// Tests that a plan is followed from ten milliseconds after the tick that it was made from, with its speed
// and torque ahead of eq. (17): c1 = 1000, c2 = 30, k_2 = 3.68.
TEST_F(PlannerTest, APlanIsFollowed) {
  StartPlanned();
  SendState(0, 0.02);
  arm_plan_t plan = Plan(0, 0, {0, 0.02}, {0, 0.2});
  plan.arm_speed = {10, 10};
  plan.torque = {36.8, 36.8};
  Send(plan);
  for (int64_t tick = 1; tick <= 15; ++tick) SendState(tick, 0.02);
  ASSERT_EQ(references_.size(), 4u);
  EXPECT_EQ(references_[1].value, 0.02) << "at tick 5 it is not in force yet";
  EXPECT_DOUBLE_EQ(references_[2].value, 0.1);
  EXPECT_DOUBLE_EQ(references_[3].value, 0.15);
  EXPECT_DOUBLE_EQ(commands_[2].pressure_ref,
                   1000 * (0.1 - 0.02) + 30 * 10 + 36.8 / SmallStack().model.description.parameters.k_2);
}

TEST_F(PlannerTest, APlanThatIsWrongIsNotFollowed) {
  StartPlanned();
  SendState(0, 0.02);
  Send(Plan(0, 0, {0, 1}, {0.02, NAN}));
  Send(Plan(1, 0, {0, 1}, {0.02, 0.6}));
  for (int64_t tick = 1; tick <= 15; ++tick) SendState(tick, 0.02);
  app_->Poll();
  Deliver();
  EXPECT_EQ(references_.back().value, 0.02);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "refused_arm_plan");
  EXPECT_THAT(
      faults_[0].text,
      ::testing::HasSubstr("2 plans in all are not followed; the newest: point 1: found arm angle 0.6 rad"));
}

TEST_F(PlannerTest, ASilentPlannersReferenceIsHeld) {
  StartPlanned();
  SendState(0, 0.02);
  Send(Plan(0, -1, {0, 0.1}, {0, 0.1}));
  for (int64_t tick = 1; tick <= 80; ++tick) SendState(tick, 0.02);
  EXPECT_NEAR(references_.back().value, references_[6].value, 1e-12) << "30 ms after the plan it is held";
  EXPECT_LT(references_.back().value, 0.05);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "silent_planner");
  EXPECT_TRUE(faults_[0].active);
  Send(Plan(1, -1, {0, 0.1}, {0, 0.1}));
  SendState(85, 0.02);
  Deliver();
  ASSERT_EQ(faults_.size(), 2u);
  EXPECT_FALSE(faults_[1].active);
}

struct PassThrough {
  settings::ReferenceSignal signal;
  double pressure_ref, voltage;
  bool open_loop;
  int8_t code;
};
class PassThroughTest : public PositionAppTest, public ::testing::WithParamInterface<PassThrough> {};

// Tests that the other references pass through: pressure as it is, torque through k_2, voltage as open loop.
TEST_P(PassThroughTest, PassesTheReferenceThrough) {
  Start(WithReference(GetParam().signal, 184));
  SendState(5, 0);
  ASSERT_EQ(commands_.size(), 1u);
  EXPECT_DOUBLE_EQ(commands_[0].pressure_ref, GetParam().pressure_ref);
  EXPECT_EQ(commands_[0].voltage, GetParam().voltage);
  EXPECT_EQ(commands_[0].open_loop, GetParam().open_loop);
  EXPECT_EQ(references_[0].signal, GetParam().code);
  EXPECT_EQ(references_[0].value, 184);
}

INSTANTIATE_TEST_SUITE_P(Signals, PassThroughTest,
                         ::testing::Values(PassThrough{settings::ReferenceSignal::kPressure, 184, 0, false,
                                                       arm_reference_t::PRESSURE},
                                           PassThrough{settings::ReferenceSignal::kTorque, 50, 0, false,
                                                       arm_reference_t::TORQUE},
                                           PassThrough{settings::ReferenceSignal::kVoltage, 0, 184, true,
                                                       arm_reference_t::VOLTAGE}));

// Tests that the torque limit holds for every kind of reference and that the D/A has its levels.
TEST_F(PositionAppTest, LimitsAndQuantises) {
  settings::StackConfig config = WithReference(settings::ReferenceSignal::kPressure, 1000);
  config.limits.arm_torque_in_lbf = 3.68 * 300.3;
  config.position.dac_bits = 12;
  config.position.dac_range_psi = 2048;
  Start(config);
  SendState(5, 0);
  EXPECT_DOUBLE_EQ(commands_.at(0).pressure_ref, 300);
}

// Tests that an arm angle that is not finite gives an open-loop command of zero volts and a fault, and that
// the loop starts afresh, without a derivative across the gap, when the angle is back.
TEST_F(PositionAppTest, NonFiniteAngleGivesZeroVolts) {
  Start(WithReference(settings::ReferenceSignal::kArmAngle, 0));
  SendState(0, 0.1);
  SendState(5, std::nan(""));
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_TRUE(commands_[1].open_loop);
  EXPECT_EQ(commands_[1].voltage, 0);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "nonfinite_arm_angle");
  SendState(10, 0.2);
  EXPECT_FALSE(commands_.at(2).open_loop);
  EXPECT_DOUBLE_EQ(commands_[2].pressure_ref, -1000 * 0.2);
  EXPECT_FALSE(faults_.back().active);
}

// Tests that a resent state gets the same answer again.
TEST_F(PositionAppTest, RepeatsTheAnswerToARepeatedState) {
  Start(WithReference(settings::ReferenceSignal::kArmAngle, 0));
  SendState(0, 0.1);
  SendState(0, 0.1);
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_EQ(commands_[0].sequence, commands_[1].sequence);
  EXPECT_EQ(commands_[0].pressure_ref, commands_[1].pressure_ref);
}

// Tests that a sample overtaken by states that are no samples is answered, that one overtaken by a newer
// sample is not, and that overtaken states repeat no answer.
TEST_F(PositionAppTest, OvertakenSamples) {
  Start(WithReference(settings::ReferenceSignal::kArmAngle, 0.1));
  for (const int64_t tick : {0, 1, 2, 3, 4, 6, 7, 5, 8, 6, 15, 10, 14, 20}) SendState(tick, 0);
  std::vector<int64_t> ticks, numbers;
  for (const auto& c : commands_) {
    ticks.push_back(c.tick);
    numbers.push_back(c.sequence);
  }
  EXPECT_THAT(ticks, ElementsAre(0, 5, 15, 20));
  EXPECT_THAT(numbers, ElementsAre(0, 1, 2, 3));
}

// Tests that a loop that leaves a running stack does not leave its last pressure in force, and that at the
// end of a run, when every process leaves, it sends no further command.
TEST_F(PositionAppTest, LeavesWithZeroVolts) {
  Start(WithReference(settings::ReferenceSignal::kArmAngle, 0));
  SendState(0, 0.1);
  SendState(3, 0.1);
  EXPECT_EQ(app_->Finish(), 0);
  Deliver();
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_EQ(commands_[1].tick, 3);
  EXPECT_TRUE(commands_[1].open_loop);
  EXPECT_EQ(commands_[1].voltage, 0);
}
TEST_F(PositionAppTest, AddsNothingAfterTheEnd) {
  Start(WithReference(settings::ReferenceSignal::kArmAngle, 0));
  SendState(0, 0.1);
  bus_.Publish("HYDRO_STOP", stop_t{});
  Deliver();
  EXPECT_EQ(app_->Finish(), 0);
  Deliver();
  EXPECT_EQ(commands_.size(), 1u);
}

// Tests that in lockstep a silent plant ends this process with an error in less than 2 s.
TEST_F(PositionAppTest, LockstepEndsWhenThePlantStalls) {
  Start(WithReference(settings::ReferenceSignal::kArmAngle, 0));
  SendState(0, 0);
  clock_.AdvanceTo(clock_.Now() + 1890ms);
  app_->Poll();
  EXPECT_FALSE(app_->finished());
  clock_.AdvanceTo(clock_.Now() + 20ms);
  app_->Poll();
  EXPECT_TRUE(app_->finished());
  EXPECT_EQ(app_->Finish(), 1);
}

}  // namespace
}  // namespace hydro::position_ctrl
