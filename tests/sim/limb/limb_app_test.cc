// A limb as an application in real time, on a clock that the test moves.
#include "sim/limb/limb_app.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hydro/motor_command_t.hpp>
#include <hydro/output_left_t.hpp>
#include <hydro/process_status_t.hpp>
#include <hydro/stop_t.hpp>
#include <map>

#include "bus/in_process_bus.h"
#include "tests/sim/limb/limb_fixture.h"

namespace hydro::limb {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using testing::SmallLimb;

class LimbAppTest : public ::testing::Test {
 protected:
  LimbAppTest() : config_(SmallLimb({"hip", "knee"})) {
    config_.common.time.mode = settings::TimeMode::kRealtime;
    config_.limb.telemetry_interval_ticks = 10;
    for (const std::string suffix : {"", "_hip", "_knee"}) {
      const bus::Channels channels(suffix);
      bus_.Subscribe<state_t>(channels.Of<state_t>(), [this, suffix](const state_t& s) {
        states_[suffix].push_back(s);
        if (on_state_) on_state_(suffix, s);
      });
      bus_.Subscribe<fault_t>(channels.Of<fault_t>(),
                              [this, suffix](const fault_t& f) { faults_[suffix].push_back(f); });
      bus_.Subscribe<stop_t>(channels.Of<stop_t>(),
                             [this, suffix](const stop_t& s) { stops_[suffix].push_back(s); });
      bus_.Subscribe<output_left_t>(channels.Of<output_left_t>(),
                                    [this, suffix](const output_left_t& o) { left_[suffix].push_back(o); });
      bus_.Subscribe<process_status_t>(channels.Of<process_status_t>(),
                                       [this, suffix](const process_status_t& s) {
                                         if (s.role == "limb" || s.role == "plant")
                                           states_of_[suffix].push_back(s.state);
                                       });
    }
  }

  int Run(const std::vector<std::string>& joints = {}) {
    LimbApp app(bus_, clock_, config_, {.joints = joints, .expected = {}, .heartbeat = {}});
    const int exit_code = app.Run();
    while (bus_.HandleUntil(clock_.Now()) > 0) {
    }
    return exit_code;
  }

  settings::LimbConfig config_;
  bus::SimulatedClock clock_;
  bus::InProcessBus bus_{&clock_};
  std::map<std::string, std::vector<state_t>> states_;
  std::map<std::string, std::vector<fault_t>> faults_;
  std::map<std::string, std::vector<stop_t>> stops_;
  std::map<std::string, std::vector<output_left_t>> left_;
  std::map<std::string, std::vector<int8_t>> states_of_;
  std::function<void(const std::string& suffix, const state_t& state)> on_state_;
};

// Tests that each joint's states are on its own channels at the chosen rate, its end with zero volts, and the
// limb's status on its own.
TEST_F(LimbAppTest, WhatOthersSee) {
  EXPECT_EQ(Run(), 0);
  EXPECT_EQ(states_.count(""), 0U);
  for (const std::string suffix : {"_hip", "_knee"}) {
    EXPECT_GE(states_[suffix].size(), 11U);
    EXPECT_LE(states_[suffix].size(), 13U);
    EXPECT_EQ(states_[suffix].back().tick, 100);
    ASSERT_EQ(left_[suffix].size(), 1U);
    EXPECT_EQ(left_[suffix][0].voltage, 0);
    EXPECT_EQ(states_of_[suffix].back(), process_status_t::DONE);
  }
  EXPECT_EQ(states_of_[""].front(), process_status_t::READY);
  EXPECT_EQ(states_of_[""].back(), process_status_t::DONE);
}

// Tests that the limb describes itself again when the loggers that it waits for are there: a short run has no
// later description.
TEST_F(LimbAppTest, DescribesItselfToTheLogger) {
  int descriptions = 0;
  bool logger = false;
  bus_.Subscribe<run_description_t>("HYDRO_RUN", [&](const run_description_t& description) {
    EXPECT_EQ(description.config_text, config_.common.text);
    descriptions += logger ? 1 : 0;
    if (std::exchange(logger, true)) return;
    process_status_t status{};
    status.session = 9;
    status.role = "logger";
    status.state = process_status_t::READY;
    bus_.Publish("HYDRO_PROCESS_STATUS", status);
  });
  LimbApp app(bus_, clock_, config_, {.joints = {}, .expected = {"logger"}, .heartbeat = {}});
  EXPECT_EQ(app.Run(), 0);
  EXPECT_EQ(descriptions, 1);
}

// Tests that a stop on the limb's channel and one on a joint's end all joints in order.
class LimbStopTest : public LimbAppTest, public ::testing::WithParamInterface<std::string> {};
TEST_P(LimbStopTest, EndsAllJoints) {
  on_state_ = [&](const std::string&, const state_t& state) {
    if (state.tick < 40) return;
    stop_t stop{};
    stop.session = 77;
    stop.source = "launch";
    stop.reason = "enough";
    bus_.Publish(bus::Channels(GetParam()).Of<stop_t>(), stop);
  };
  EXPECT_EQ(Run(), 0);
  EXPECT_LT(states_["_hip"].back().tick, 60);
  EXPECT_LT(states_["_knee"].back().tick, 60);
}
INSTANTIATE_TEST_SUITE_P(Suffixes, LimbStopTest, ::testing::Values("", "_knee"));

// Tests that a fault in a joint that another process runs holds these at zero volts while it lasts, and that
// it is told on their channels.
TEST_F(LimbAppTest, FaultOfAJointElsewhere) {
  on_state_ = [&](const std::string& suffix, const state_t& state) {
    if (suffix != "_hip" || (state.tick / 10 != 3 && state.tick / 10 != 6)) return;
    fault_t fault{};
    fault.session = 77;
    fault.source = "plant";
    fault.code = "pressure_limit";
    fault.active = state.tick / 10 == 3;
    bus_.Publish(bus::Channels("_knee").Of<fault_t>(), fault);
  };
  EXPECT_EQ(Run({"hip"}), 0);
  EXPECT_EQ(states_.count("_knee"), 0U);
  ASSERT_EQ(faults_["_hip"].size(), 2U);
  EXPECT_EQ(faults_["_hip"][0].code, "other_joint");
  EXPECT_THAT(faults_["_hip"][0].text, HasSubstr("joint knee has the fault pressure_limit (plant)"));
  int held = 0;
  for (const state_t& state : states_["_hip"]) {
    if (state.tick < 40 || state.tick > 60) continue;
    EXPECT_EQ(state.voltage, 0) << state.tick;
    ++held;
  }
  EXPECT_GE(held, 2);
  EXPECT_NE(states_["_hip"].back().voltage, 0);
}

// Tests that a joint of another process that is no longer heard holds all joints at zero volts until it is
// heard again: one says which it is, the other follows that one.
TEST_F(LimbAppTest, SilenceOfAJointElsewhere) {
  config_.joints.push_back(config_.joints.back());
  config_.joints.back().name = "ankle";
  config_.joints.back().config.bus.channel_suffix = "_ankle";
  config_.common.limits.stale_input_s = 0.005;
  config_.limb.telemetry_interval_ticks = 1;  // three of them: 3 ms, so 8 in all
  on_state_ = [&](const std::string& suffix, const state_t& state) {
    if (suffix != "_hip" || (state.tick > 20 && state.tick < 70)) return;
    state_t ankle{};
    ankle.session = 77;
    bus_.Publish("HYDRO_STATE_ankle", ankle);
  };
  EXPECT_EQ(Run({"hip", "knee"}), 0);
  ASSERT_EQ(faults_["_hip"].size(), 2U);
  EXPECT_EQ(faults_["_hip"][0].code, "joint_gone");
  EXPECT_THAT(faults_["_hip"][0].text,
              HasSubstr("joint ankle, which another process runs, has not been heard"));
  ASSERT_EQ(faults_["_knee"].size(), 2U);
  EXPECT_EQ(faults_["_knee"][0].code, "other_joint");
  EXPECT_THAT(faults_["_knee"][0].text, HasSubstr("joint hip has the fault joint_gone"));
  for (const std::string suffix : {"_hip", "_knee"}) {
    for (const state_t& state : states_[suffix]) {
      if (state.tick >= 20 + 8 + 3 && state.tick < 70) {
        EXPECT_EQ(state.voltage, 0) << suffix << state.tick;
      }
    }
    EXPECT_NE(states_[suffix].back().voltage, 0);
  }
}

// Tests that a flood from outside, of states and commands in a joint's channels and of processes that do not
// exist, changes nothing of what the joints do.
TEST_F(LimbAppTest, AFloodFromOutside) {
  constexpr int64_t kForeign = 1'000'000'000;  // the sessions from here on
  const auto without = [&](const std::string& suffix) {
    std::vector<state_t> own;
    for (const state_t& state : states_[suffix]) {
      if (state.session < kForeign || state.session >= 2 * kForeign) own.push_back(state);
    }
    return own;
  };
  // On a bus of its own: what an application has subscribed to a bus stays there.
  bus::SimulatedClock quiet_clock;
  bus::InProcessBus quiet{&quiet_clock};
  std::vector<state_t> hip, knee;
  quiet.Subscribe<state_t>(bus::Channels("_hip").Of<state_t>(), [&](const state_t& s) { hip.push_back(s); });
  quiet.Subscribe<state_t>(bus::Channels("_knee").Of<state_t>(),
                           [&](const state_t& s) { knee.push_back(s); });
  LimbApp undisturbed(quiet, quiet_clock, config_, {.joints = {}, .expected = {}, .heartbeat = {}});
  ASSERT_EQ(undisturbed.Run(), 0);
  while (quiet.HandleUntil(quiet_clock.Now()) > 0) {
  }
  ASSERT_FALSE(hip.empty());

  int64_t sent = 0;
  on_state_ = [&](const std::string& suffix, const state_t& state) {
    if (suffix != "_hip" || (state.session >= kForeign && state.session < 2 * kForeign)) return;
    for (int i = 0; i < 200; ++i) {
      const bus::Channels channels(i % 2 == 0 ? "_hip" : "_knee");
      state_t foreign = state;
      foreign.session = kForeign + ++sent;
      foreign.sequence = int64_t{1} << (sent % 63);
      foreign.voltage = 5;
      bus_.Publish(channels.Of<state_t>(), foreign);
      motor_command_t command{};
      command.session = foreign.session;
      command.tick = state.tick;
      command.voltage = 5;
      bus_.Publish(channels.Of<motor_command_t>(), command);
      process_status_t status{};
      status.session = foreign.session;
      status.role = i % 3 == 0 ? "logger" : "tool";
      status.state = process_status_t::RUNNING;
      status.text = std::string(1000, 'x');
      bus_.Publish(channels.Of<process_status_t>(), status);
    }
  };
  EXPECT_EQ(Run(), 0);
  EXPECT_GE(sent, 2000);
  for (const auto& [suffix, before] : {std::pair{std::string("_hip"), &hip}, {std::string("_knee"), &knee}}) {
    const std::vector<state_t> own = without(suffix);
    ASSERT_EQ(own.size(), before->size()) << suffix;
    for (size_t i = 0; i < own.size(); ++i) {
      EXPECT_EQ(own[i].tick, (*before)[i].tick);
      EXPECT_EQ(own[i].voltage, (*before)[i].voltage) << suffix << " " << own[i].tick;
      EXPECT_EQ(own[i].arm_angle, (*before)[i].arm_angle) << suffix << " " << own[i].tick;
    }
    EXPECT_TRUE(faults_[suffix].empty()) << faults_[suffix].front().code;
  }
}

// Tests that a joint that fails ends the limb with an error that names it.
TEST_F(LimbAppTest, FailureNamesTheJoint) {
  config_.joints[1].config.limits.motor_speed_rad_s = 1;
  EXPECT_EQ(Run(), 1);
  ASSERT_FALSE(stops_[""].empty());
  EXPECT_THAT(stops_[""].back().reason, HasSubstr("knee: plant: fault motor_speed_limit"));
  EXPECT_EQ(states_of_[""].back(), process_status_t::FAILED);
  for (const std::string suffix : {"_hip", "_knee"}) {
    ASSERT_EQ(left_[suffix].size(), 1U);
    EXPECT_EQ(left_[suffix][0].voltage, 0);
  }
}

}  // namespace
}  // namespace hydro::limb
