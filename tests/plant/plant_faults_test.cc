// PlantApp's faults on a simulated clock: what end-to-end tests cannot do to a machine, and exact ticks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <hydro/active_faults_t.hpp>
#include <hydro/fault_t.hpp>
#include <hydro/log_progress_t.hpp>
#include <hydro/rearm_t.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "bus/in_process_bus.h"
#include "plant/plant_app.h"
#include "plant/simulated_rig.h"
#include "tests/stack_fixture.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::SmallStack;

// A clock whose wall time can be set and whose machine can be suspended.
class DisturbedClock : public bus::SimulatedClock {
 public:
  int64_t Utime() const override { return bus::SimulatedClock::Utime() + step_us; }
  Duration Suspended() const override { return suspended; }

  int64_t step_us = 0;
  Duration suspended{};
};

class PlantFaultsTest : public ::testing::Test {
 protected:
  PlantFaultsTest() {
    config_.time.mode = settings::TimeMode::kRealtime;
    StartAgain();
  }

  // Starts another run, with nothing left of the one before.
  void StartAgain() {
    clock_ = DisturbedClock();
    bus_ = std::make_unique<bus::InProcessBus>(&clock_);
    states_.clear();
    faults_.clear();
    answers_.clear();
    sequence_ = 0;
    bus_->Subscribe<state_t>("HYDRO_STATE", [this](const state_t& s) {
      states_.push_back(s);
      if (on_state_) on_state_(s);
      if (answering_) Answer(s.tick, voltage_);
    });
    bus_->Subscribe<fault_t>("HYDRO_FAULT", [this](const fault_t& f) { faults_.push_back(f); });
    bus_->Subscribe<rearm_t>("HYDRO_REARM", [this](const rearm_t& r) {
      if (r.kind != rearm_t::REQUEST) answers_.push_back(r);
    });
  }

  int Run() {
    SimulatedRig rig(config_);
    PlantApp plant(*bus_, clock_, config_, rig, expected_, "hydro-plant", heartbeat_);
    for (const char* role : {"pressure_ctrl", "position_ctrl"}) Status(role, 1, process_status_t::READY);
    const int exit_code = plant.Run();
    failure_ = plant.failure();
    while (bus_->HandleUntil(clock_.Now()) > 0) {
    }
    return exit_code;
  }

  void Status(const std::string& role, int64_t session, int8_t state, const std::string& text = "") {
    process_status_t status;
    status.session = session;
    status.role = role;
    status.host = "rig";
    status.pid = 7;
    status.state = state;
    status.text = text;
    bus_->Publish("HYDRO_PROCESS_STATUS", status);
  }

  void Answer(int64_t tick, double voltage, int8_t status = motor_command_t::LAW) {
    motor_command_t c{};
    c.tick = tick;
    c.session = 1;
    c.sequence = sequence_++;
    c.voltage = voltage;
    c.status = status;
    bus_->Publish("HYDRO_MOTOR_COMMAND", c);
  }

  void AskToRearm(int64_t tick, int64_t addressee = 0) {
    rearm_t request;
    request.tick = tick;
    request.session = 5;
    request.addressee = addressee;
    request.kind = rearm_t::REQUEST;
    bus_->Publish("HYDRO_REARM", request);
  }

  std::vector<std::string> Codes() const {
    std::vector<std::string> codes;
    for (const fault_t& f : faults_) codes.push_back((f.active != 0 ? "+" : "-") + f.code);
    return codes;
  }

  // Voltages of the states from `first` to `last` are all `voltage`.
  void ExpectVoltage(int64_t first, int64_t last, double voltage) const {
    for (const state_t& s : states_) {
      if (s.tick >= first && s.tick <= last) {
        EXPECT_EQ(s.voltage, voltage) << s.tick;
      }
    }
  }

  DisturbedClock clock_;
  std::unique_ptr<bus::InProcessBus> bus_;
  settings::StackConfig config_ = SmallStack();
  std::function<void(const state_t&)> on_state_;
  std::function<bool()> heartbeat_;
  std::vector<std::string> expected_;
  bool answering_ = true;
  double voltage_ = 1.5;  // of our answers
  std::vector<state_t> states_;
  std::vector<fault_t> faults_;
  std::vector<rearm_t> answers_;
  std::string failure_;
  int64_t sequence_ = 0;
};

// Tests that a request that was accepted does not end what has begun since, when it is delivered again.
TEST_F(PlantFaultsTest, ARearmEndsNothingThatBeganAfterIt) {
  config_.limits.rearm = settings::Rearm::kExplicit;
  config_.last_tick = 200;
  on_state_ = [this](const state_t& s) {
    answering_ = false;
    Answer(s.tick, s.tick == 10 || s.tick == 60 ? 99 : 1.5);
    if (s.tick == 40 || s.tick == 100) AskToRearm(40);
    if (s.tick == 150) AskToRearm(150);
  };
  EXPECT_EQ(Run(), 0);
  ASSERT_EQ(answers_.size(), 3u);
  EXPECT_EQ(answers_[0].kind, rearm_t::ACCEPTED);
  EXPECT_EQ(answers_[1].kind, rearm_t::REFUSED);
  EXPECT_THAT(answers_[1].text, HasSubstr("names tick 40; a fault has begun since, at tick 61"));
  EXPECT_EQ(answers_[2].kind, rearm_t::ACCEPTED);
  ExpectVoltage(62, 150, 0);
}

// Tests that suspending the machine ends the run at zero volts, in the next tick, with a latched fault.
TEST_F(PlantFaultsTest, SuspendEndsTheRun) {
  on_state_ = [this](const state_t& s) {
    if (s.tick == 50) clock_.suspended = 3h;
  };
  EXPECT_EQ(Run(), 1);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "machine_suspended");
  EXPECT_EQ(faults_[0].tick, 51);
  EXPECT_TRUE(faults_[0].latched);
  EXPECT_EQ(faults_[0].value, 3 * 3600);
  EXPECT_EQ(states_.back().tick, 51);
  EXPECT_THAT(failure_, HasSubstr("suspended"));
}

// Tests that with explicit re-arming a suspend holds zero volts until a re-arm, though the suspend is over at
// once.
TEST_F(PlantFaultsTest, SuspendWaitsForARearm) {
  config_.limits.rearm = settings::Rearm::kExplicit;
  on_state_ = [this](const state_t& s) {
    if (s.tick == 50) clock_.suspended = 3h;
    if (s.tick == 80) AskToRearm(80);
  };
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(Codes(), ::testing::ElementsAre("+machine_suspended", "-machine_suspended"));
  ExpectVoltage(10, 51, 1.5);
  ExpectVoltage(52, 81, 0);
  ExpectVoltage(83, 100, 1.5);
}

// Of the joint knee, which another process runs.
class SilentJointTest : public PlantFaultsTest {
 protected:
  SilentJointTest() { config_.siblings = {{.name = "knee", .suffix = "_knee", .silence_s = 0.010}}; }

  void KneeIsHeard() {
    state_t state{};
    state.session = 77;
    bus_->Publish("HYDRO_STATE_knee", state);
  }
  void KneeSays(int8_t state, const std::string& text = "") {
    process_status_t status{};
    status.session = 77;
    status.role = "plant";
    status.state = state;
    status.text = text;
    bus_->Publish("HYDRO_PROCESS_STATUS_knee", status);
  }
};

// Tests that a joint that was heard and is no longer holds zero volts until it is heard again, and that the
// fault says which.
TEST_F(SilentJointTest, HoldsZeroVolts) {
  on_state_ = [this](const state_t& s) {
    if (s.tick <= 40 || s.tick >= 70) KneeIsHeard();
  };
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(Codes(), ::testing::ElementsAre("+joint_gone", "-joint_gone"));
  EXPECT_THAT(faults_[0].text,
              HasSubstr("joint knee, which another process runs, has not been heard for 0.011 s, "
                        "allowed are 0.01 s"));
  ExpectVoltage(10, 51, 1.5);
  ExpectVoltage(52, 71, 0);
  ExpectVoltage(74, 100, 1.5);
}

// Tests that with explicit re-arming the motor does not start again when the joint is heard again, but by a
// re-arm.
TEST_F(SilentJointTest, WaitsForARearm) {
  config_.limits.rearm = settings::Rearm::kExplicit;
  on_state_ = [this](const state_t& s) {
    if (s.tick <= 40 || s.tick >= 60) KneeIsHeard();
    if (s.tick == 55 || s.tick == 80) AskToRearm(s.tick);
  };
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(Codes(), ::testing::ElementsAre("+joint_gone", "-joint_gone"));
  ASSERT_EQ(answers_.size(), 2U);
  EXPECT_EQ(answers_[0].kind, rearm_t::REFUSED);
  EXPECT_THAT(answers_[0].text, HasSubstr("joint_gone persists: "));
  EXPECT_EQ(answers_[1].kind, rearm_t::ACCEPTED);
  ExpectVoltage(53, 81, 0);
  ExpectVoltage(83, 100, 1.5);
}

// Tests that a stop of a joint, or its failure, ends this one's run too, with its name and exit code; but not
// where it ends at the run's last tick, and not where joints do not concern each other.
TEST_F(SilentJointTest, ItsEndIsOurs) {
  const auto run = [this](int64_t at, int exit_code, int64_t addressee) {
    StartAgain();
    on_state_ = [this, at, exit_code, addressee](const state_t& s) {
      KneeIsHeard();
      if (s.tick != at) return;
      stop_t stop{};
      stop.session = 77;
      stop.tick = at;
      stop.addressee = addressee;
      stop.exit_code = exit_code;
      stop.reason = "a limit";
      bus_->Publish("HYDRO_STOP_knee", stop);
    };
    return Run();
  };
  EXPECT_EQ(run(50, 1, 77), 1);
  EXPECT_THAT(failure_, HasSubstr("joint knee: a limit"));
  EXPECT_LT(states_.back().tick, 53);
  EXPECT_EQ(run(50, 0, 0), 0);
  EXPECT_LT(states_.back().tick, 53);
  EXPECT_EQ(run(50, 0, 78), 0) << "another run's";
  EXPECT_EQ(states_.back().tick, 100);
  EXPECT_EQ(run(config_.last_tick, 0, 77), 0);
  EXPECT_EQ(states_.back().tick, 100);
  config_.joints_concern_each_other = false;
  EXPECT_EQ(run(50, 1, 77), 0);
  EXPECT_EQ(states_.back().tick, 100);
}

// Tests that a joint that has failed without a stop that was heard ends this one's run too.
TEST_F(SilentJointTest, ItsFailureIsOurs) {
  on_state_ = [this](const state_t& s) {
    KneeIsHeard();
    if (s.tick == 50) KneeSays(process_status_t::FAILED, "the board is gone");
  };
  EXPECT_EQ(Run(), 1);
  EXPECT_THAT(failure_, HasSubstr("joint knee: the board is gone"));
  EXPECT_LT(states_.back().tick, 53);
}

// Tests that the run waits for a joint of another process that it was told to expect, and names it when it
// does not come.
TEST_F(SilentJointTest, IsExpected) {
  config_.time.start_timeout_s = 0.5;
  expected_ = {"joint:knee"};
  EXPECT_EQ(Run(), 1);
  EXPECT_THAT(failure_, HasSubstr("not ready after 0.5 s (time.start_timeout_s): joint knee"));
  EXPECT_THAT(states_, IsEmpty());
  StartAgain();
  bus_->Subscribe<process_status_t>("HYDRO_PROCESS_STATUS", [this](const process_status_t& status) {
    if (status.role == "plant" && status.state == process_status_t::READY) KneeSays(process_status_t::READY);
  });
  EXPECT_EQ(Run(), 0);
  EXPECT_EQ(states_.back().tick, 100);
}

// Tests that a joint that is about to begin is told at once which faults this one has.
TEST_F(SilentJointTest, ANewcomerIsToldOfFaults) {
  std::vector<std::string> told;
  bus_->Subscribe<active_faults_t>("HYDRO_ACTIVE_FAULTS",
                                   [&](const active_faults_t& active) { told.push_back(active.codes); });
  size_t before = 0;
  on_state_ = [&](const state_t& s) {
    if (s.tick <= 20) KneeIsHeard();
    if (s.tick != 50) return;
    before = told.size();
    KneeSays(process_status_t::READY);
  };
  EXPECT_EQ(Run(), 0);
  ASSERT_GT(told.size(), before);
  EXPECT_EQ(told[before], "joint_gone");
}

// Tests that neither a joint that was never heard nor one that has said that it leaves is missed, though a
// state of it comes late.
TEST_F(SilentJointTest, WhoLeavesIsNotMissed) {
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(faults_, IsEmpty());
  StartAgain();
  on_state_ = [this](const state_t& s) {
    if (s.tick <= 30) KneeIsHeard();
    if (s.tick != 30) return;
    KneeSays(process_status_t::DONE);
    KneeIsHeard();
  };
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(faults_, IsEmpty());
}

// Tests that setting the wall clock by ten seconds, forwards and back, changes nothing in a state but its
// time stamp.
TEST_F(PlantFaultsTest, ClockStepChangesNothing) {
  ASSERT_EQ(Run(), 0);
  const std::vector<state_t> even = states_;
  StartAgain();
  on_state_ = [this](const state_t& s) {
    if (s.tick == 30) clock_.step_us = 10'000'000;
    if (s.tick == 60) clock_.step_us = -10'000'000;
  };
  ASSERT_EQ(Run(), 0);
  EXPECT_THAT(faults_, IsEmpty());
  ASSERT_EQ(states_.size(), even.size());
  EXPECT_GT(std::abs(states_[50].utime - even[50].utime), 5'000'000);
  for (size_t k = 0; k < even.size(); ++k) {
    state_t state = states_[k];
    state.utime = even[k].utime;
    std::vector<uint8_t> a(state.getEncodedSize()), b(state.getEncodedSize());
    state.encode(a.data(), 0, static_cast<int>(a.size()));
    even[k].encode(b.data(), 0, static_cast<int>(b.size()));
    EXPECT_EQ(a, b) << k;
  }
}

// Tests that with the limits of a real-time machine, five ticks, a pressure loop that falls silent is noticed
// in the sixth and the voltage is zero from the next state on.
TEST_F(PlantFaultsTest, FiveTicks) {
  config_.limits.stale_input_s = 0.005;
  on_state_ = [this](const state_t& s) { answering_ = s.tick < 50; };
  EXPECT_EQ(Run(), 0);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "stale_motor_command");
  EXPECT_LE(faults_[0].tick, 50 + 6);
  ExpectVoltage(faults_[0].tick + 1, 100, 0);
  ExpectVoltage(10, faults_[0].tick, 1.5);
}

// Tests that one command for a tick far in the future, with the loop's own session, costs the voltage only
// until the next good one.
TEST_F(PlantFaultsTest, OneFutureCommandDeafensNobody) {
  on_state_ = [this](const state_t& s) {
    answering_ = s.tick != 50;
    if (!answering_) Answer(int64_t{1} << 62, voltage_);
  };
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(Codes(), ::testing::ElementsAre("+future_motor_command", "-future_motor_command"));
  ExpectVoltage(52, 52, 0);
  ExpectVoltage(53, 100, 1.5);
}

// Tests that it is told even where the good one has come before the plant looks, as on a busy machine.
TEST_F(PlantFaultsTest, OneFutureCommandBesideAGoodOneIsTold) {
  on_state_ = [this](const state_t& s) {
    if (s.tick == 50) Answer(int64_t{1} << 62, voltage_);
  };
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(Codes(), ::testing::ElementsAre("+future_motor_command", "-future_motor_command"));
  ExpectVoltage(52, 52, 0);
  ExpectVoltage(53, 100, 1.5);
}

// Tests that one with a far sequence number deafens it for no longer than stale_input_s, so that the last
// voltage stays in force until then.
TEST_F(PlantFaultsTest, OneFarNumberDeafensNobody) {
  config_.limits.stale_input_s = 0.02;
  on_state_ = [this](const state_t& s) {
    answering_ = s.tick != 50;
    if (answering_) return;
    const int64_t before = std::exchange(sequence_, int64_t{1} << 62);
    Answer(50, voltage_);
    sequence_ = before;
  };
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(Codes(), ::testing::ElementsAre("+repeated_motor_command"));
  ExpectVoltage(53, 100, 1.5);
  EXPECT_GT(states_.back().command_tick, 95);
}

// Tests that a launcher that falls silent after it has been heard gives zero volts until it is heard again,
// and that one that was never there is not missed.
TEST_F(PlantFaultsTest, SupervisorGone) {
  config_.last_tick = 400;
  config_.limits.stale_supervisor_s = 0.1;
  bool beats = true;
  on_state_ = [&](const state_t& s) { beats = s.tick < 100 || s.tick >= 300; };
  heartbeat_ = [&] { return beats; };
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(Codes(), ::testing::ElementsAre("+supervisor_gone", "-supervisor_gone"));
  ExpectVoltage(10, 195, 1.5);
  ExpectVoltage(215, 299, 0);
  ExpectVoltage(315, 400, 1.5);

  StartAgain();
  on_state_ = {};
  heartbeat_ = [] { return false; };
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(faults_, IsEmpty());
}

// Tests that after a stop of its own the plant obeys no command from before the stop.
TEST_F(PlantFaultsTest, LatePlantWaitsForAFreshCommand) {
  config_.limits.stale_input_s = 0.02;
  int64_t awake = 0;
  on_state_ = [&](const state_t& s) {
    answering_ = s.skipped_ticks == 0 && (awake == 0 || s.tick > awake + 5);
    if (s.skipped_ticks > 0) awake = s.tick;
    if (s.tick == 30) clock_.AdvanceTo(clock_.Now() + 25ms);
  };
  EXPECT_EQ(Run(), 0);
  ASSERT_GT(awake, 50);
  ASSERT_GE(faults_.size(), 2u);
  EXPECT_EQ(faults_.back().code, "late_plant");
  EXPECT_EQ(faults_.front().tick, awake);
  EXPECT_THAT(Codes(), ::testing::Contains("+late_plant"));
  ExpectVoltage(awake + 1, awake + 6, 0);
  EXPECT_EQ(states_.back().voltage, 1.5);
}

// Tests that the plant itself watches each limit: zero volts from the tick in which it is exceeded.
TEST_F(PlantFaultsTest, LimitsEndTheRun) {
  struct Case {
    const char* code;
    double settings::LimitsSection::*limit;
    double value;
  };
  voltage_ = 9;
  for (const Case& c : {Case{"pressure_limit", &settings::LimitsSection::pressure_psi, 102},
                        Case{"motor_speed_limit", &settings::LimitsSection::motor_speed_rad_s, 5},
                        Case{"arm_angle_limit", &settings::LimitsSection::arm_angle_rad, 1e-6}}) {
    StartAgain();
    config_.limits = settings::LimitsSection{};
    config_.limits.*c.limit = c.value;
    EXPECT_EQ(Run(), 1);
    ASSERT_EQ(faults_.size(), 1u) << c.code;
    EXPECT_EQ(faults_[0].code, c.code);
    EXPECT_TRUE(faults_[0].latched);
    EXPECT_EQ(faults_[0].tick, states_.back().tick);
    EXPECT_GT(faults_[0].value, c.value);
  }
}

// Tests re-arm commands: to another session, of an old tick, while the cause persists, and a good one.
TEST_F(PlantFaultsTest, Rearm) {
  config_.limits.rearm = settings::Rearm::kExplicit;
  config_.last_tick = 7000;
  on_state_ = [this](const state_t& s) {
    const bool bad = s.tick >= 10 && s.tick < 30;
    answering_ = false;
    Answer(s.tick, bad ? 99 : 1.5);
    if (s.tick == 20) AskToRearm(20);
    if (s.tick == 40) AskToRearm(40, 1234);
    if (s.tick == 5500) AskToRearm(400);
    if (s.tick == 5600) AskToRearm(5601);  // it has not been
    if (s.tick == 6000) AskToRearm(5990);
    if (s.tick == 6500) AskToRearm(6500);
  };
  EXPECT_EQ(Run(), 0);
  ASSERT_EQ(answers_.size(), 5u);
  EXPECT_EQ(answers_[0].kind, rearm_t::REFUSED);
  EXPECT_THAT(answers_[0].text,
              HasSubstr("excessive_motor_command persists: tick 11: the motor command is 99 V"));
  EXPECT_THAT(answers_[1].text, HasSubstr("names tick 400"));
  EXPECT_THAT(answers_[2].text, HasSubstr("names tick 5601"));
  EXPECT_EQ(answers_[3].kind, rearm_t::ACCEPTED);
  EXPECT_EQ(answers_[3].text, "ended excessive_motor_command");
  EXPECT_EQ(answers_[3].addressee, 5);
  EXPECT_EQ(answers_[4].kind, rearm_t::NOTHING_LATCHED);
  EXPECT_EQ(answers_[4].text, "no fault is latched");
  ExpectVoltage(12, 6001, 0);
  ExpectVoltage(6003, 7000, 1.5);
}

// Tests that a safe output of the pressure loop is latched where faults are ended explicitly, and only there.
TEST_F(PlantFaultsTest, SafeCommand) {
  on_state_ = [this](const state_t& s) {
    answering_ = s.tick != 40;
    if (!answering_) Answer(s.tick, 0, motor_command_t::SAFE);
  };
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(faults_, IsEmpty());
  ExpectVoltage(43, 100, 1.5);

  StartAgain();
  config_.limits.rearm = settings::Rearm::kExplicit;
  EXPECT_EQ(Run(), 1);  // it was not re-armed
  EXPECT_THAT(Codes(), ::testing::ElementsAre("+controller_fault"));
  ExpectVoltage(42, 100, 0);
  EXPECT_THAT(failure_, HasSubstr("controller_fault"));
}

// Tests that volts of a command that says that it is safe, the last, or of no known kind are not put out.
TEST_F(PlantFaultsTest, VoltsOfASafeCommand) {
  for (const int8_t status : {motor_command_t::SAFE, motor_command_t::STOPPED, int8_t{99}}) {
    StartAgain();
    on_state_ = [&](const state_t& s) {
      answering_ = s.tick < 40 || s.tick > 60;
      if (!answering_) Answer(s.tick, 5, status);
    };
    EXPECT_EQ(Run(), 0);
    ExpectVoltage(5, 41, 1.5);
    ExpectVoltage(42, 62, 0);
    ExpectVoltage(63, 100, 1.5);
  }
}

// Tests that a fault of the position loop is latched too, that it persists until the loop ends it or is
// replaced, and that a warning is not latched.
TEST_F(PlantFaultsTest, FaultOfThePositionLoop) {
  config_.limits.rearm = settings::Rearm::kExplicit;
  const auto fault = [this](const char* code, bool active) {
    fault_t f{};
    f.session = 33;
    f.source = "position_ctrl";
    f.code = code;
    f.active = active;
    bus_->Publish("HYDRO_FAULT", f);
  };
  on_state_ = [&](const state_t& s) {
    if (s.tick == 10) fault("undecodable_message", true);
    if (s.tick == 20) fault("nonfinite_arm_angle", true);
    if (s.tick == 30) AskToRearm(30);
    if (s.tick == 40) Status("position_ctrl", 34, process_status_t::READY);
    if (s.tick == 50) AskToRearm(50);
  };
  EXPECT_EQ(Run(), 0);
  ASSERT_EQ(answers_.size(), 2u);
  EXPECT_THAT(answers_[0].text, HasSubstr("position_ctrl: nonfinite_arm_angle"));
  EXPECT_EQ(answers_[1].kind, rearm_t::ACCEPTED);
  ExpectVoltage(5, 20, 1.5);
  ExpectVoltage(22, 51, 0);
  ExpectVoltage(54, 100, 1.5);
}

// Tests that a fault which its sender no longer has, or which nobody claims, refuses no re-arm: the message
// that said that it has ended may be lost, and one with wrong bits may name a process that never was.
TEST_F(PlantFaultsTest, FaultThatNobodyClaims) {
  config_.limits.rearm = settings::Rearm::kExplicit;
  config_.last_tick = 6000;
  const auto begins = [this](int64_t session, const char* code) {
    fault_t f{};
    f.session = session;
    f.source = "position_ctrl";
    f.code = code;
    f.active = true;
    bus_->Publish("HYDRO_FAULT", f);
  };
  const auto has = [this](int64_t session, const char* codes) {
    active_faults_t list{};
    list.session = session;
    list.codes = codes;
    bus_->Publish("HYDRO_ACTIVE_FAULTS", list);
  };
  on_state_ = [&](const state_t& s) {
    if (s.tick == 10) begins(33, "nonfinite_arm_angle");
    if (s.tick == 20) has(33, "undecodable_message nonfinite_arm_angle");
    if (s.tick == 30) AskToRearm(30);  // persists
    if (s.tick == 40) has(33, "undecodable_message");
    if (s.tick == 50) AskToRearm(50);
    if (s.tick == 100) begins(77, "nonfinite_arm_angle");
    if (s.tick == 2500) AskToRearm(2500);  // persists
    if (s.tick == 2700) AskToRearm(2700);
  };
  EXPECT_EQ(Run(), 0);
  std::vector<int> kinds;
  for (const rearm_t& answer : answers_) kinds.push_back(answer.kind);
  EXPECT_THAT(kinds, ::testing::ElementsAre(rearm_t::REFUSED, rearm_t::ACCEPTED, rearm_t::REFUSED,
                                            rearm_t::ACCEPTED));
  ExpectVoltage(54, 100, 1.5);
  ExpectVoltage(102, 2701, 0);
  ExpectVoltage(2704, 6000, 1.5);
}

// Tests that a second plant on the channels is named, with the multicast group in its description.
TEST_F(PlantFaultsTest, OtherStack) {
  config_.last_tick = 4000;
  on_state_ = [this](const state_t& s) {
    if (s.tick != 50) return;
    run_description_t other;
    other.session = 77;
    other.program = "hydro-plant";
    other.host = "neighbour";
    other.config_text = "[bus]\nurl = \"udpm://239.1.2.3:7667?ttl=1\"\n";
    bus_->Publish("HYDRO_RUN", other);
  };
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(Codes(), ::testing::ElementsAre("+other_stack", "-other_stack"));
  EXPECT_THAT(faults_[0].text,
              HasSubstr("hydro-plant on neighbour (session 77, its bus.url = \"udpm://239.1.2.3"));
  ExpectVoltage(52, 2500, 0);
  EXPECT_EQ(states_.back().voltage, 1.5);
}

// Tests that a logger that falls silent is a warning, which ends when there is one again, and that the
// plant's own silence is not blamed on the logger.
TEST_F(PlantFaultsTest, LoggerGone) {
  config_.last_tick = 3000;
  config_.limits.stale_logger_s = 0.5;
  const auto progress = [this](int64_t session, int64_t tick) {
    log_progress_t p{};
    p.session = session;
    p.tick = tick;
    bus_->Publish("HYDRO_LOG_PROGRESS", p);
  };
  on_state_ = [&](const state_t& s) {
    if (s.tick < 1000) progress(8, s.tick);
    if (s.tick == 500) clock_.AdvanceTo(clock_.Now() + 60ms);
    if (s.tick == 2000) progress(9, s.tick);
    if (s.tick > 2000) progress(9, s.tick);
  };
  Status("logger", 8, process_status_t::RUNNING);
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(Codes(), ::testing::ElementsAre("+logger_gone", "-logger_gone"));
  EXPECT_GE(faults_[0].tick, 1500);
  EXPECT_LE(faults_[0].tick, 1505);
  EXPECT_GE(faults_[1].tick, 2000);
  ExpectVoltage(600, 3000, 1.5);
}

// Tests that made-up loggers, each heard once, are not missed, and do not hide that one is gone that had
// recorded.
TEST_F(PlantFaultsTest, MadeUpLoggers) {
  config_.last_tick = 3000;
  config_.limits.stale_logger_s = 0.5;
  on_state_ = [&](const state_t& s) {
    if (s.tick < 1000) Status("logger", 8, process_status_t::RUNNING);
    if (s.tick < 100) Status("logger", 1000 + s.tick, process_status_t::RUNNING);
  };
  EXPECT_EQ(Run(), 0);
  EXPECT_THAT(Codes(), ::testing::ElementsAre("+logger_gone"));
  EXPECT_GE(faults_[0].tick, 1500);
}

// Tests that the warning quotes the reason that a leaving logger gives.
TEST_F(PlantFaultsTest, LoggerFailed) {
  on_state_ = [&](const state_t& s) {
    if (s.tick == 5) Status("logger", 8, process_status_t::RUNNING);
    if (s.tick == 20) Status("logger", 8, process_status_t::FAILED, "no space left");
  };
  EXPECT_EQ(Run(), 0);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "logger_gone");
  EXPECT_THAT(faults_[0].text, HasSubstr("logger on rig (process 7)"));
  EXPECT_THAT(faults_[0].text, HasSubstr("no space left"));
  ExpectVoltage(10, 100, 1.5);
}

}  // namespace
}  // namespace hydro::plant
