#include "launch/logic/operator_request.h"

#include <gmock/gmock.h>

#include <hydro/active_faults_t.hpp>
#include <hydro/process_status_t.hpp>
#include <hydro/rearm_t.hpp>
#include <hydro/run_description_t.hpp>
#include <hydro/state_t.hpp>
#include <hydro/stop_t.hpp>
#include <hydro/tuned_settings_t.hpp>
#include <memory>

#include "bus/channels.h"
#include "bus/in_process_bus.h"
#include "tests/settings/small_texts.h"

namespace hydro::launch {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// Something sends whenever the bus is looked at.
class LivelyBus : public bus::InProcessBus {
 public:
  explicit LivelyBus(bus::SimulatedClock* clock) : InProcessBus(clock), clock_(*clock) {}
  int HandleUntil(TimePoint deadline) override {
    for (const auto& send : senders) send();
    const int handled = InProcessBus::HandleUntil(deadline);
    clock_.AdvanceTo(deadline);
    return handled;
  }
  std::vector<std::function<void()>> senders;

 private:
  bus::SimulatedClock& clock_;
};

// A plant of one joint: its states, and its answer to a re-arm.
class FakePlant {
 public:
  FakePlant(LivelyBus& bus, const std::string& suffix, int64_t session, int8_t kind, const std::string& text)
      : channels_(suffix) {
    bus.senders.push_back([this, &bus, session] {
      state_t state{};
      state.session = session;
      state.tick = ++tick_;
      state.command_tick = held_ && active_.empty() ? -1 : tick_ - 1;
      state.voltage = 2.5;
      state.arm_angle = 0.125;
      state.time = 1e-3 * static_cast<double>(tick_);
      bus.Publish(channels_.Of<state_t>(), state);
      if (!active_.empty() && tick_ % 10 == 0) {
        active_faults_t active{};
        active.session = session;
        active.codes = active_;
        bus.Publish(channels_.Of<active_faults_t>(), active);
      }
      if (!describes_itself_ || tick_ % 10 != 5) return;
      run_description_t run{};
      run.config_text = settings::kConfigText;
      run.model_text = settings::kModelText;
      run.rate_hz = 1000;
      bus.Publish(channels_.Of<run_description_t>(), run);
      tuned_settings_t in_force{};
      in_force.stage = tuned_settings_t::IN_FORCE;
      bus.Publish(channels_.Of<tuned_settings_t>(), in_force);
    });
    bus.Subscribe<rearm_t>(channels_.Of<rearm_t>(), [=, this, &bus](const rearm_t& request) {
      if (request.kind != rearm_t::REQUEST || request.addressee != session) return;
      ++asked_;
      held_ = held_ && kind != rearm_t::ACCEPTED;
      rearm_t answer = request;
      answer.session = session;
      answer.addressee = request.session;
      answer.kind = kind;
      answer.source = "plant";
      answer.text = text;
      bus.Publish(channels_.Of<rearm_t>(), answer);
    });
    bus.Subscribe<stop_t>(channels_.Of<stop_t>(), [=, this, &bus](const stop_t&) {
      ++stopped_;
      process_status_t status{};
      status.session = session;
      status.role = "plant";
      status.host = "far";
      status.pid = 7;  // the limb's: that of all its joints
      status.state = process_status_t::DONE;
      bus.Publish(channels_.Of<process_status_t>(), status);
      bus.senders.clear();
    });
  }

  void Hold() {
    held_ = describes_itself_ = true;
    tick_ = 1000;  // after the step of kConfigText
  }
  // These faults are active, and the device says that it acts by a command.
  void Lie(const std::string& active) { active_ = active; }
  int asked() const { return asked_; }
  int stopped() const { return stopped_; }

 private:
  const bus::Channels channels_;
  int64_t tick_ = 0;
  bool held_ = false;  // at zero volts
  bool describes_itself_ = false;
  std::string active_;
  int asked_ = 0;
  int stopped_ = 0;
};

class NoProcesses : public LocalProcesses {
 public:
  int found() const override { return 0; }
  bool Found(int) const override { return false; }
  std::string Left() override { return ""; }
};

// What a forecast says of the machine, as far as it is the same whatever the loops leave.
const std::string kMotion = "; by its model no limit ends that within 10.5 s, after which the arm is at 0.";

class OperatorRequestTest : public ::testing::Test {
 protected:
  OperatorRequestTest() {
    config_.joints = {"hip", "knee"};
    config_.bus.joint_suffixes = {"_hip", "_knee"};
  }
  void OneJoint() {
    config_.joints.clear();
    config_.bus.joint_suffixes.clear();
    config_.bus.channel_suffix = "_hip";
  }
  FakePlant& Add(const std::string& suffix, int64_t session, int8_t kind, const std::string& text) {
    return *plants_.emplace_back(std::make_unique<FakePlant>(bus_, suffix, session, kind, text));
  }

  bus::SimulatedClock clock_;
  LivelyBus bus_{&clock_};
  settings::StackConfig config_;
  std::vector<std::unique_ptr<FakePlant>> plants_;
};

// Tests that a limb's joints are asked together, and that their answers are one: the same ones side by side.
TEST_F(OperatorRequestTest, RearmsAllJoints) {
  Add("_hip", 1, rearm_t::ACCEPTED, "ended pressure_limit");
  Add("_knee", 2, rearm_t::ACCEPTED, "ended pressure_limit");
  const OperatorResult result = RearmStack(bus_, clock_, config_);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.text, StartsWith("re-armed: hip, knee: ended pressure_limit"));
  EXPECT_GE(plants_[0]->asked(), 1);
  EXPECT_EQ(plants_[1]->asked(), plants_[0]->asked());
}

// Tests that a re-arm with nothing to end is refused, of a stack and of a limb.
TEST_F(OperatorRequestTest, NothingToEnd) {
  OneJoint();
  Add("_hip", 1, rearm_t::NOTHING_LATCHED, "no fault is latched");
  const OperatorResult result = RearmStack(bus_, clock_, config_);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.text, "refused by the plant: no fault is latched");
  EXPECT_TRUE(result.forecasts.empty());
}

TEST_F(OperatorRequestTest, NothingToEndInALimb) {
  Add("_hip", 1, rearm_t::NOTHING_LATCHED, "no fault is latched");
  Add("_knee", 2, rearm_t::NOTHING_LATCHED, "no fault is latched");
  const OperatorResult result = RearmStack(bus_, clock_, config_);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.text, "hip, knee: no fault is latched");
}

// Tests a device that says that it acts by a command while a fault holds the voltage: a re-arm moves the
// machine all the same, and what is told says where to, before and after.
void ExpectToldOfADeviceThatActs(const OperatorResult& told) {
  EXPECT_EQ(told.exit_code, 0);
  ASSERT_EQ(told.forecasts.size(), 1u);
  EXPECT_TRUE(told.forecasts[0].second.known && told.forecasts[0].second.held);
  EXPECT_THAT(told.text, HasSubstr("the reference moves by -0.025 rad"));
  EXPECT_THAT(told.text,
              HasSubstr("the device says that it acts by a command, with 2.5 V, though a fault holds"));
}

TEST_F(OperatorRequestTest, ForecastsOfADeviceThatSaysItActs) {
  OneJoint();
  FakePlant& plant = Add("_hip", 1, rearm_t::ACCEPTED, "ended rig_fault");
  plant.Hold();
  plant.Lie("logger_gone rig_fault");
  ExpectToldOfADeviceThatActs(ForecastRearm(bus_, clock_, config_));
}

TEST_F(OperatorRequestTest, RearmsADeviceThatSaysItActs) {
  OneJoint();
  FakePlant& plant = Add("_hip", 1, rearm_t::ACCEPTED, "ended rig_fault");
  plant.Hold();
  plant.Lie("logger_gone rig_fault");
  ExpectToldOfADeviceThatActs(RearmStack(bus_, clock_, config_));
}

// Tests that a warning of the plant holds nothing.
TEST_F(OperatorRequestTest, AWarningHoldsNothing) {
  OneJoint();
  FakePlant& plant = Add("_hip", 1, rearm_t::NOTHING_LATCHED, "no fault is latched");
  plant.Hold();
  plant.Lie("logger_gone");
  EXPECT_THAT(ForecastRearm(bus_, clock_, config_).text, HasSubstr("re-arming changes nothing"));
}

// Tests that a re-arm says where the machine moves by it, of the joints that were held: from the state in
// which it was asked, though the plant drives again before it has described itself.
TEST_F(OperatorRequestTest, SaysWhereItMoves) {
  Add("_hip", 1, rearm_t::ACCEPTED, "ended pressure_limit").Hold();
  Add("_knee", 2, rearm_t::NOTHING_LATCHED, "no fault is latched");
  const OperatorResult result = RearmStack(bus_, clock_, config_);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(
      result.text,
      StartsWith(
          "re-armed: hip: ended pressure_limit; knee: no fault is latched; hip: the arm is at 0.125 rad; its "
          "reference comes back to 0.1 rad: the reference moves by -0.025 rad in 0.5 s, at up to 0.05 rad/s" +
          kMotion));
  ASSERT_EQ(result.forecasts.size(), 2u);
  EXPECT_EQ(result.forecasts[0].first, "hip");
  EXPECT_TRUE(result.forecasts[0].second.known);
  EXPECT_FALSE(result.forecasts[1].second.held);
}

// Tests that the same is told before, in the same words, and that nobody is asked for anything; and what is
// said where there is nothing to tell.
TEST_F(OperatorRequestTest, ForecastsWithoutARequest) {
  OneJoint();
  Add("_hip", 1, rearm_t::ACCEPTED, "").Hold();
  const OperatorResult result = ForecastRearm(bus_, clock_, config_);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.text, StartsWith("the arm is at 0.125 rad; its reference comes back to 0.1 rad: the "
                                      "reference moves by -0.025 rad in "
                                      "0.5 s, at up to 0.05 rad/s" +
                                      kMotion));
  EXPECT_EQ(plants_[0]->asked(), 0);
}

TEST_F(OperatorRequestTest, ForecastsOfOneThatDrives) {
  OneJoint();
  Add("_hip", 1, rearm_t::ACCEPTED, "");
  EXPECT_THAT(ForecastRearm(bus_, clock_, config_).text, HasSubstr("re-arming changes nothing"));
}

TEST_F(OperatorRequestTest, ForecastsOfNobody) {
  OneJoint();
  EXPECT_EQ(ForecastRearm(bus_, clock_, config_).exit_code, 1);
}

// Tests that the log says who asked.
TEST_F(OperatorRequestTest, SaysWhoRearms) {
  std::vector<std::string> said;
  bus_.Subscribe<rearm_t>("HYDRO_REARM_hip", [&](const rearm_t& rearm) {
    if (rearm.kind == rearm_t::REQUEST) said.push_back(rearm.source + ": " + rearm.text);
  });
  OneJoint();
  Add("_hip", 1, rearm_t::ACCEPTED, "");
  RearmStack(bus_, clock_, config_, {}, kScopePage);
  ASSERT_FALSE(said.empty());
  EXPECT_EQ(said.back(), "scope: Re-arm on the page of hydro-scope");
}

TEST_F(OperatorRequestTest, SaysWhoStops) {
  std::vector<std::string> said;
  bus_.Subscribe<stop_t>("HYDRO_STOP_hip",
                         [&](const stop_t& stop) { said.push_back(stop.source + ": " + stop.reason); });
  OneJoint();
  Add("_hip", 1, rearm_t::ACCEPTED, "");
  NoProcesses none;
  StopOverBus(bus_, clock_, config_, none, {}, kScopePage);
  ASSERT_FALSE(said.empty());
  EXPECT_EQ(said.back(), "scope: STOP on the page of hydro-scope");
}

// Tests that one refusal fails the whole, and comes first.
TEST_F(OperatorRequestTest, ARefusalFailsTheWhole) {
  Add("_hip", 1, rearm_t::ACCEPTED, "ended pressure_limit");
  Add("_knee", 2, rearm_t::REFUSED, "pressure_limit persists");
  const OperatorResult result = RearmStack(bus_, clock_, config_);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.text, "knee: refused by the plant: pressure_limit persists; hip: ended pressure_limit");
}

// Tests that a joint that is not heard keeps all others from being re-armed.
TEST_F(OperatorRequestTest, AMissingJointKeepsTheOthersFromIt) {
  Add("_hip", 1, rearm_t::ACCEPTED, "ended pressure_limit");
  EXPECT_THAT(RearmStack(bus_, clock_, config_).text, HasSubstr("no plant or driver of knee is heard on "));
  EXPECT_EQ(plants_[0]->asked(), 0);
}

// Tests that a joint is re-armed by itself where it alone is meant.
TEST_F(OperatorRequestTest, OneJointAlone) {
  Add("_hip", 1, rearm_t::ACCEPTED, "ended pressure_limit");
  OneJoint();
  EXPECT_THAT(RearmStack(bus_, clock_, config_).text, StartsWith("re-armed: ended pressure_limit"));
}

// Tests that a second plant on a joint's channels is named with the joint.
TEST_F(OperatorRequestTest, TwoPlantsOfAJoint) {
  Add("_hip", 1, rearm_t::ACCEPTED, "");
  Add("_knee", 2, rearm_t::ACCEPTED, "");
  Add("_knee", 3, rearm_t::ACCEPTED, "");
  EXPECT_THAT(RearmStack(bus_, clock_, config_).text, HasSubstr("knee: heard the states of 2 plants"));
}

// Tests that a stop reaches each joint on its channels, and that joints of one process count as one.
TEST_F(OperatorRequestTest, StopsAllJoints) {
  Add("_hip", 1, rearm_t::ACCEPTED, "");
  Add("_knee", 2, rearm_t::ACCEPTED, "");
  NoProcesses none;
  const OperatorResult result = StopOverBus(bus_, clock_, config_, none);
  EXPECT_EQ(result.exit_code, 0) << result.text;
  EXPECT_EQ(result.text, "stopped: 1 process has ended");
  EXPECT_GE(plants_[0]->stopped(), 1);
  EXPECT_GE(plants_[1]->stopped(), 1);
}

}  // namespace
}  // namespace hydro::launch
