#include "sim/limb/telemetry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hydro/arm_plan_t.hpp>
#include <hydro/fault_t.hpp>
#include <hydro/loop_statistics_t.hpp>
#include <hydro/motor_command_t.hpp>
#include <hydro/rearm_t.hpp>
#include <hydro/state_t.hpp>

#include "bus/channels.h"
#include "bus/in_process_bus.h"

namespace hydro::limb {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr int64_t kOwn = 5, kForeign = 9;

class TelemetryTest : public ::testing::Test {
 protected:
  explicit TelemetryTest(int64_t interval = 10) : telemetry_(out_, interval) {
    out_.Subscribe<state_t>("HYDRO_STATE_hip", [this](const state_t& s) { states_.push_back(s); });
    out_.SubscribeAll([this](const bus::RawMessage& m) { channels_.emplace_back(m.channel); });
    telemetry_.Add(joint_, "_hip", 0, [](int64_t session) { return session == kOwn; });
  }

  template <class Message>
  void Say(Message message, int64_t session = kOwn) {
    message.session = session;
    joint_.Publish(bus::Channels("_hip").Of<Message>(), message);
    joint_.HandleUntil({});
  }

  void SayState(int64_t tick, int64_t skipped = 0) {
    state_t state{};
    state.tick = tick;
    state.sequence = tick;
    state.p1 = 0.5 * static_cast<double>(tick);
    state.skipped_ticks = skipped;
    Say(state);
  }

  void Deliver() {
    while (out_.HandleUntil({}) > 0) {
    }
  }

  bus::SimulatedClock clock_;
  bus::InProcessBus joint_{&clock_}, out_{&clock_};
  Telemetry telemetry_;
  std::vector<state_t> states_;
  std::vector<std::string> channels_;
};

// Tests that one state of each interval goes out, counted anew, and that its other fields are those that were
// published.
TEST_F(TelemetryTest, OneStateAnInterval) {
  for (int64_t tick = 0; tick <= 35; ++tick) SayState(tick);
  telemetry_.SendAll();
  Deliver();
  ASSERT_EQ(states_.size(), 4U);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(states_[i].tick, 10 * static_cast<int64_t>(i));
    EXPECT_EQ(states_[i].sequence, static_cast<int64_t>(i));
    EXPECT_EQ(states_[i].p1, 5.0 * static_cast<double>(i));
  }
}

// Tests that a state tells of the ticks that were skipped before the states in between.
TEST_F(TelemetryTest, SkippedTicksAddUp) {
  for (int64_t tick = 0; tick <= 20; ++tick)
    SayState(tick, tick == 3 ? 2 : tick == 7 ? 1 : tick == 20 ? 4 : 0);
  telemetry_.SendAll();
  Deliver();
  ASSERT_EQ(states_.size(), 3U);
  EXPECT_EQ(states_[1].skipped_ticks, 3);
  EXPECT_EQ(states_[2].skipped_ticks, 4);
}

// Tests that late ticks, which jump over the start of an interval, cost no sample.
TEST_F(TelemetryTest, JumpsOverTheStart) {
  for (const int64_t tick : {0, 9, 14, 15, 33, 39}) SayState(tick);
  telemetry_.SendAll();
  Deliver();
  ASSERT_EQ(states_.size(), 3U);
  EXPECT_EQ(states_[1].tick, 14);
  EXPECT_EQ(states_[2].tick, 33);
}

// Tests that a fault goes out at once, before what waits, and that only the joint's own messages do.
TEST_F(TelemetryTest, FaultsAtOnce) {
  SayState(0);
  Say(fault_t{});
  Deliver();
  EXPECT_THAT(channels_, ElementsAre("HYDRO_FAULT_hip"));
  Say(rearm_t{}, kForeign);  // came from outside
  Deliver();
  EXPECT_THAT(channels_, ElementsAre("HYDRO_FAULT_hip"));
  telemetry_.SendAll();
  Deliver();
  EXPECT_THAT(channels_, ElementsAre("HYDRO_FAULT_hip", "HYDRO_STATE_hip"));
}

// Tests that what comes from outside never goes back.
TEST_F(TelemetryTest, PlansStayInside) {
  Say(arm_plan_t{});
  telemetry_.SendAll();
  Deliver();
  EXPECT_THAT(channels_, IsEmpty());
}

// Tests that at least one message is sent, and no more than there is time for.
TEST_F(TelemetryTest, SendsWhileItMay) {
  for (int i = 0; i < 5; ++i) Say(loop_statistics_t{});
  int asked = 0;
  telemetry_.Send([&] { return ++asked < 3; });
  EXPECT_EQ(telemetry_.waiting(), 2U);
  telemetry_.Send([] { return false; });
  EXPECT_EQ(telemetry_.waiting(), 1U);
}

// Tests that a queue that nobody empties is bounded, and what is left out is counted.
TEST_F(TelemetryTest, Bounded) {
  for (int i = 0; i < 20000; ++i) Say(loop_statistics_t{});
  EXPECT_EQ(telemetry_.waiting() + static_cast<size_t>(telemetry_.left_out()), 20000U);
  EXPECT_GT(telemetry_.left_out(), 0);
}

// Tests that everything goes out as it is when each tick is asked for, also two commands for one tick.
class EveryTick : public TelemetryTest {
 protected:
  EveryTick() : TelemetryTest(1) {}
};
TEST_F(EveryTick, AllGoOut) {
  for (int64_t tick = 0; tick < 4; ++tick) SayState(tick);
  SayState(3);
  telemetry_.SendAll();
  Deliver();
  ASSERT_EQ(states_.size(), 5U);
  EXPECT_EQ(states_[3].tick, 3);
}

}  // namespace
}  // namespace hydro::limb
