#include "runs/log/causal_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hydro::log {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Kind = CausalOrder::Kind;

// Takes messages named after their contents, with both loops acting on every tick unless the test says
// otherwise.
class CausalOrderTest : public ::testing::Test {
 protected:
  void Take(Kind kind, int64_t tick) {
    static constexpr const char* kNames[] = {"none", "state", "motor", "pressure", "reference"};
    order_.Take(kind, tick, {kNames[static_cast<int>(kind)] + std::to_string(tick), {}, 0}, now_);
  }
  void TakeAnswers(int64_t tick) {
    Take(Kind::kArmReference, tick);
    Take(Kind::kPressureCommand, tick);
    Take(Kind::kMotorCommand, tick);
  }

  bus::Clock::TimePoint now_{};
  std::vector<std::string> out_;
  CausalOrder order_{1, 2, false, [this](RecordedMessage message) { out_.push_back(message.channel); }};
};

// Tests that messages in order pass at once.
TEST_F(CausalOrderTest, OrderedMessagesPass) {
  Take(Kind::kState, 0);
  TakeAnswers(0);
  Take(Kind::kState, 1);
  Take(Kind::kMotorCommand, 1);
  EXPECT_THAT(out_, ElementsAre("state0", "reference0", "pressure0", "motor0", "state1", "motor1"));
  EXPECT_FALSE(order_.held_since());
}

// Tests that a state that overtook an answer to the previous tick waits for it.
TEST_F(CausalOrderTest, StateWaitsForTheAnswersBeforeIt) {
  Take(Kind::kState, 0);
  Take(Kind::kPressureCommand, 0);
  now_ += std::chrono::milliseconds(7);
  Take(Kind::kState, 1);
  EXPECT_THAT(out_, ElementsAre("state0", "pressure0"));
  EXPECT_EQ(order_.held_since(), now_);
  Take(Kind::kMotorCommand, 0);
  EXPECT_THAT(out_, ElementsAre("state0", "pressure0", "motor0", "state1"));
  EXPECT_FALSE(order_.held_since());
}

// Tests that answers which overtook their state come out behind it.
TEST_F(CausalOrderTest, AnswersWaitForTheirState) {
  TakeAnswers(0);
  EXPECT_THAT(out_, IsEmpty());
  EXPECT_TRUE(order_.held_since());
  Take(Kind::kState, 0);
  EXPECT_THAT(out_, ElementsAre("state0", "reference0", "pressure0", "motor0"));
}

// Tests that an early state and an early answer to it come out in order once the late answer is there.
TEST_F(CausalOrderTest, AnswerToAHeldStateStaysBehindIt) {
  Take(Kind::kState, 0);
  Take(Kind::kMotorCommand, 0);
  Take(Kind::kState, 1);
  Take(Kind::kMotorCommand, 1);
  EXPECT_THAT(out_, ElementsAre("state0", "motor0"));
  Take(Kind::kPressureCommand, 0);
  EXPECT_THAT(out_, ElementsAre("state0", "motor0", "pressure0", "state1", "motor1"));
}

// Tests that a loop owes no answer to ticks that are no multiples of its interval.
TEST_F(CausalOrderTest, SlowLoopOwesNothingBetweenItsSamples) {
  Take(Kind::kState, 1);
  Take(Kind::kMotorCommand, 1);
  Take(Kind::kState, 2);
  EXPECT_THAT(out_, ElementsAre("state1", "motor1", "state2"));
}

// Where a command acts from its own tick on.
class SameTickTest : public CausalOrderTest {
 protected:
  SameTickTest() {
    order_ = CausalOrder(1, 2, true, [this](RecordedMessage message) { out_.push_back(message.channel); });
  }
};

// Tests that a motor command waits for the pressure command of its tick, which it follows from, and the next
// state for it.
TEST_F(SameTickTest, MotorCommandWaitsForThePressureCommand) {
  Take(Kind::kState, 0);
  Take(Kind::kMotorCommand, 0);
  Take(Kind::kState, 1);
  EXPECT_THAT(out_, ElementsAre("state0"));
  EXPECT_TRUE(order_.held_since());
  Take(Kind::kPressureCommand, 0);
  EXPECT_THAT(out_, ElementsAre("state0", "pressure0", "motor0", "state1"));
  EXPECT_FALSE(order_.held_since());
  Take(Kind::kMotorCommand, 1);  // no sample of the position loop
  EXPECT_EQ(out_.back(), "motor1");
}

// Tests that both wait for a state that they overtook, in their order.
TEST_F(SameTickTest, BothWaitForTheirState) {
  Take(Kind::kMotorCommand, 0);
  Take(Kind::kPressureCommand, 0);
  EXPECT_THAT(out_, IsEmpty());
  Take(Kind::kState, 0);
  EXPECT_THAT(out_, ElementsAre("state0", "pressure0", "motor0"));
  EXPECT_FALSE(order_.held_since());
}

// Tests that a motor command whose pressure command was lost comes out with Release().
TEST_F(SameTickTest, LostPressureCommandHoldsNothingForEver) {
  Take(Kind::kState, 0);
  Take(Kind::kMotorCommand, 0);
  order_.Release();
  EXPECT_THAT(out_, ElementsAre("state0", "motor0"));
  EXPECT_FALSE(order_.held_since());
}

// Tests that nothing is lost when an answer never comes: the next state, or Release(), lets out what is held.
TEST_F(CausalOrderTest, LostAnswersHoldNothingForEver) {
  Take(Kind::kState, 0);
  Take(Kind::kState, 1);
  EXPECT_THAT(out_, ElementsAre("state0"));
  Take(Kind::kState, 2);
  EXPECT_THAT(out_, ElementsAre("state0", "state1"));
  order_.Release();
  EXPECT_THAT(out_, ElementsAre("state0", "state1", "state2"));
  EXPECT_FALSE(order_.held_since());
  Take(Kind::kMotorCommand, 9);
  order_.Release();
  EXPECT_EQ(out_.back(), "motor9");
}

}  // namespace
}  // namespace hydro::log
