// PlantApp on a rig other than the simulated one: when it drives, when it does not, and how it ends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <hydro/configuration_t.hpp>
#include <hydro/fault_t.hpp>
#include <hydro/stop_t.hpp>
#include <set>

#include "bus/in_process_bus.h"
#include "plant/plant_app.h"
#include "tests/plant/run_plant.h"
#include "tests/stack_fixture.h"

namespace hydro::plant {
namespace {

using testing::SmallStack;

// Remembers its calls; reads what the test sets.
class RecordingRig : public Rig {
 public:
  std::string role() const override { return "driver"; }
  model::Measurement Read(int64_t tick) override {
    if (on_read) on_read(tick);
    model::Measurement measured;
    measured.p1 = measured.p2 = 100;
    return measured;
  }
  const std::vector<RigFault>& faults() const override { return faults_now; }
  double Drive(double voltage) override {
    driven.push_back(voltage);
    output = std::clamp(voltage, -2.0, 2.0);
    return output;
  }
  OutputLeft Zero() noexcept override {
    output = 0;
    ++zeros;
    if (waits && when_late_) std::exchange(when_late_, {})();
    if (after_waiting) after_waiting();
    return {.accepted = accepts_zero, .voltage = reads_back};
  }

  bool accepts_zero = true;
  bool waits = false;  // for its device, which does not answer
  std::function<void()> after_waiting;
  double reads_back = 0;

  std::function<void(int64_t)> on_read;
  std::vector<RigFault> faults_now;
  std::vector<double> driven;
  double output = 0;
  int zeros = 0;
};

class PlantRigTest : public ::testing::Test {
 protected:
  PlantRigTest() {
    config_.time.mode = settings::TimeMode::kRealtime;
    bus_.Subscribe<state_t>("HYDRO_STATE", [this](const state_t& s) {
      states_.push_back(s);
      motor_command_t command{};
      command.tick = s.tick;
      command.session = 1;
      command.sequence = sequence_++;
      command.voltage = voltage_;
      if (answers_) bus_.Publish("HYDRO_MOTOR_COMMAND", command);
    });
    bus_.Subscribe<fault_t>("HYDRO_FAULT", [this](const fault_t& f) { faults_.push_back(f); });
    bus_.Subscribe<process_status_t>("HYDRO_PROCESS_STATUS",
                                     [this](const process_status_t& s) { roles_.insert(s.role); });
  }

  int Run() {
    const PlantOutcome outcome = RunPlant(bus_, clock_, config_, rig_, "hydro-driver");
    failure_ = outcome.failure;
    return outcome.exit_code;
  }

  bus::SimulatedClock clock_;
  bus::InProcessBus bus_{&clock_};
  settings::StackConfig config_ = SmallStack();
  RecordingRig rig_;
  bool answers_ = true;
  double voltage_ = 1.5;
  int64_t sequence_ = 0;
  std::vector<state_t> states_;
  std::vector<fault_t> faults_;
  std::set<std::string> roles_;
  std::string failure_;
};

// Tests that a run on any rig drives what was commanded, once per tick, introduces itself, and ends at zero.
TEST_F(PlantRigTest, DrivesCommands) {
  EXPECT_EQ(Run(), 0);
  EXPECT_EQ(rig_.driven.size(), 100u);
  for (const double voltage : rig_.driven) EXPECT_EQ(voltage, 1.5);
  EXPECT_EQ(states_[1].voltage, 0) << "the command of tick 0 acts from tick 1 on";
  EXPECT_EQ(states_[7].voltage, 1.5);
  EXPECT_GE(rig_.zeros, 1);
  EXPECT_EQ(rig_.output, 0);
  EXPECT_TRUE(roles_.contains("driver"));
  EXPECT_FALSE(roles_.contains("plant"));
}

// Tests that every end says what the output reads back, also one that a failing rig brings about.
TEST_F(PlantRigTest, SaysWhatItLeft) {
  std::vector<output_left_t> left;
  bus_.Subscribe<output_left_t>("HYDRO_OUTPUT_LEFT", [&](const output_left_t& l) { left.push_back(l); });
  rig_.reads_back = 3e-4;
  EXPECT_EQ(Run(), 0);
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0].role, "driver");
  EXPECT_EQ(left[0].tick, 100);
  EXPECT_TRUE(left[0].accepted);
  EXPECT_EQ(left[0].voltage, 3e-4);
  rig_.on_read = [](int64_t tick) {
    if (tick == 7) throw RigError("board_error", "does not answer");
  };
  rig_.accepts_zero = false;
  rig_.reads_back = NAN;
  EXPECT_EQ(Run(), 1);
  ASSERT_EQ(left.size(), 2u);
  EXPECT_FALSE(left[1].accepted);
  EXPECT_TRUE(std::isnan(left[1].voltage));
}

// Tests that a run whose output does not take the zero at the end has failed, however well it went, and says
// so.
TEST_F(PlantRigTest, ARefusedZeroIsAFailure) {
  rig_.accepts_zero = false;
  rig_.reads_back = 1.25;
  EXPECT_EQ(Run(), 1);
  EXPECT_THAT(failure_,
              ::testing::HasSubstr("the output has not taken zero volts at the end, and reads back 1.25 V"));
}

// Tests that where the device has to be waited for at the end, the others are told of the end before, with
// its reason: they need not wonder why no states come. What comes of it is this process's own failure.
TEST_F(PlantRigTest, TheEndIsSaidBeforeALateZero) {
  std::vector<stop_t> stops;
  bus_.Subscribe<stop_t>("HYDRO_STOP", [&](const stop_t& stop) { stops.push_back(stop); });
  for (const bool broken : {false, true}) {
    stops.clear();
    size_t said = 0;
    rig_.waits = true;
    rig_.accepts_zero = false;
    rig_.after_waiting = [&] {
      while (bus_.HandleUntil(clock_.Now()) > 0) {
      }
      said = stops.size();
    };
    if (broken) {
      rig_.on_read = [](int64_t tick) {
        if (tick == 7) throw RigError("board_error", "does not answer");
      };
    }
    EXPECT_EQ(Run(), 1);
    EXPECT_EQ(said, 1U);
    ASSERT_EQ(stops.size(), 1U) << "once";
    EXPECT_EQ(stops[0].exit_code, broken ? 1 : 0);
    EXPECT_THAT(stops[0].reason, ::testing::HasSubstr(broken ? "does not answer" : "the run is complete"));
  }
}

// Tests that without a command nothing but zero is driven.
TEST_F(PlantRigTest, ZeroUntilTheFirstCommand) {
  answers_ = false;
  EXPECT_EQ(Run(), 0);
  for (const double voltage : rig_.driven) EXPECT_EQ(voltage, 0);
}

// Tests that nothing is driven while somebody is missing.
TEST_F(PlantRigTest, NothingBeforeTheRollIsComplete) {
  PlantApp app(bus_, clock_, config_, rig_);
  EXPECT_EQ(app.Run(), 1);
  EXPECT_TRUE(rig_.driven.empty());
  EXPECT_GE(rig_.zeros, 1);
}

// Tests that states report the voltage that acts where the rig cuts it.
TEST_F(PlantRigTest, StatesTellTheVoltageThatActs) {
  voltage_ = 9;
  EXPECT_EQ(Run(), 0);
  EXPECT_EQ(rig_.driven[5], 9);
  EXPECT_EQ(states_[7].voltage, 2);
  EXPECT_GE(states_[7].command_tick, 0);
}

// Tests that the rig's own faults give zero volts from that reading on, are named one by one, and end.
TEST_F(PlantRigTest, RigFaults) {
  rig_.on_read = [this](int64_t tick) {
    rig_.faults_now.clear();
    if (tick >= 20 && tick < 40) rig_.faults_now.push_back({"sensor_p1", "p1 is gone", 1, 2});
    if (tick >= 30 && tick < 50) rig_.faults_now.push_back({"sensor_p2", "p2 is gone", 3, 4});
  };
  EXPECT_EQ(Run(), 0);
  for (int64_t k = 0; k < 100; ++k) {
    const bool at_fault = k + 1 >= 20 && k + 1 < 50;  // driven[k] follows the reading of tick k + 1
    EXPECT_EQ(rig_.driven[k], at_fault ? 0 : 1.5) << k;
  }
  EXPECT_EQ(states_[30].command_tick, -1);
  std::vector<std::string> seen;
  for (const fault_t& f : faults_)
    seen.push_back(f.code + (f.active ? " begins " : " ends ") + std::to_string(f.tick));
  EXPECT_THAT(seen, ::testing::ElementsAre("sensor_p1 begins 20", "sensor_p2 begins 30", "sensor_p1 ends 40",
                                           "sensor_p2 ends 50"));
  EXPECT_EQ(faults_[0].text, "tick 20: p1 is gone");
  EXPECT_EQ(faults_[1].limit, 4);
  EXPECT_EQ(faults_[0].source, "driver");
}

// Tests that with limits.rearm = "explicit" a rig's fault holds the voltage at zero long after it has ended,
// and that a run that ends so is no success.
TEST_F(PlantRigTest, RigFaultWaitsForARearm) {
  config_.limits.rearm = settings::Rearm::kExplicit;
  rig_.on_read = [this](int64_t tick) {
    rig_.faults_now.clear();
    if (tick >= 20 && tick < 40) rig_.faults_now.push_back({"sensor_p1", "p1 is gone", 1, 2});
  };
  EXPECT_EQ(Run(), 1);
  for (int64_t k = 0; k < 100; ++k) EXPECT_EQ(rig_.driven[k], k + 1 >= 20 ? 0 : 1.5) << k;
  const auto fault =
      std::find_if(faults_.begin(), faults_.end(), [](const fault_t& f) { return f.code == "rig_fault"; });
  ASSERT_NE(fault, faults_.end());
  EXPECT_EQ(fault->tick, 20);
  EXPECT_TRUE(fault->latched);
  EXPECT_EQ(fault->text, "sensor_p1: p1 is gone");
}

// Tests that an error of the rig ends the run with 1: zero volts, then a latched fault of its name.
TEST_F(PlantRigTest, RigError) {
  rig_.on_read = [](int64_t tick) {
    if (tick == 30) throw hydro::plant::RigError("board_error", "no answer");
  };
  EXPECT_EQ(Run(), 1);
  EXPECT_EQ(failure_, "driver: no answer");
  EXPECT_EQ(rig_.output, 0);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "board_error");
  EXPECT_TRUE(faults_[0].latched);
  EXPECT_EQ(states_.back().tick, 29);
}

// Tests that any other exception leaves zero volts behind, too.
TEST_F(PlantRigTest, OtherExceptions) {
  rig_.on_read = [](int64_t tick) {
    if (tick == 30) throw 1;
  };
  EXPECT_THROW(Run(), int);
  EXPECT_EQ(rig_.driven.back(), 1.5);
  EXPECT_EQ(rig_.output, 0);
}

// Tests that once the run has ended nothing is driven, not even in the tick in which that was heard.
TEST_F(PlantRigTest, NothingIsDrivenOnceTheRunHasEnded) {
  bus_.Subscribe<state_t>("HYDRO_STATE", [this](const state_t& s) {
    stop_t stop{};
    stop.reason = "enough";
    if (s.tick == 50) bus_.Publish("HYDRO_STOP", stop);
  });
  EXPECT_EQ(Run(), 0);
  ASSERT_EQ(rig_.driven.size(), 51u);
  EXPECT_EQ(rig_.driven[49], 1.5);
  EXPECT_EQ(rig_.driven[50], 0);
}

// Tests that what a loop has commanded before it said that it runs with another configuration never acts, and
// that what had acted before it is as old as it was.
TEST_F(PlantRigTest, CommandsOfAMisconfiguredLoopDoNotAct) {
  config_.limits.stale_input_s = 0.005;
  bus_.Subscribe<state_t>("HYDRO_STATE", [this](const state_t& s) {
    if (s.tick == 50) answers_ = false;
    if (s.tick != 70) return;
    motor_command_t command{};
    command.tick = s.tick;
    command.session = 2;
    command.voltage = 1;
    bus_.Publish("HYDRO_MOTOR_COMMAND", command);
    configuration_t other;
    other.session = 2;
    other.role = "pressure_ctrl";
    other.text = "position.c1 = 1\n";
    bus_.Publish("HYDRO_CONFIGURATION", other);
  });
  EXPECT_EQ(Run(), 0);
  EXPECT_EQ(rig_.driven[50], 1.5);
  for (size_t k = 60; k < rig_.driven.size(); ++k) EXPECT_EQ(rig_.driven[k], 0) << k;
}

// Tests that a command from before a fault does not act again when the fault has ended: only a fresh one
// does.
TEST_F(PlantRigTest, NothingOldActsAfterAFault) {
  config_.last_tick = 120;
  bus_.Subscribe<state_t>("HYDRO_STATE",
                          [this](const state_t& s) { answers_ = s.tick < 55 || s.tick >= 80; });
  rig_.on_read = [this](int64_t tick) {
    rig_.faults_now.clear();
    if (tick >= 50 && tick < 60) rig_.faults_now.push_back({"sensor_p1", "p1 is gone", 1, 2});
  };
  EXPECT_EQ(Run(), 0);
  EXPECT_EQ(rig_.driven[48], 1.5);
  for (size_t k = 49; k < 80; ++k) EXPECT_EQ(rig_.driven[k], 0) << k;
  EXPECT_EQ(rig_.driven[81], 1.5);
}

// Tests that the time that the plant itself sleeps through counts as the age of the command that acts in it.
TEST_F(PlantRigTest, SleepMakesTheCommandOlder) {
  config_.limits.stale_input_s = 0.05;
  config_.last_tick = 200;
  bus_.Subscribe<state_t>("HYDRO_STATE", [this](const state_t& s) {
    if (s.tick == 50) answers_ = false;
  });
  rig_.on_read = [this](int64_t tick) {
    if (tick == 51) clock_.AdvanceTo(clock_.Now() + std::chrono::milliseconds(40));
  };
  EXPECT_EQ(Run(), 0);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].code, "stale_motor_command");
  EXPECT_LE(faults_[0].tick, 50 + 50 + 3);
}

}  // namespace
}  // namespace hydro::plant
