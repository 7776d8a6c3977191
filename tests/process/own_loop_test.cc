#include "process/own_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/process/loop_fixture.h"

namespace hydro::process {
namespace {

using ::testing::ElementsAre;

class OwnPositionLoopTest : public LoopTest {
 protected:
  OwnPositionLoopTest() {
    config_.position_interval_ticks = 5;
    bus_.Subscribe<pressure_command_t>("HYDRO_PRESSURE_COMMAND", [this](const pressure_command_t& command) {
      commands_.push_back(command);
    });
    bus_.Subscribe<process_status_t>("HYDRO_PROCESS_STATUS", [this](const process_status_t& status) {
      if (states_.empty() || states_.back() != status.state) states_.push_back(status.state);
    });
  }

  int asked_ = 0;
  std::vector<pressure_command_t> commands_;
  std::vector<int> states_;
};

// Tests the life of a loop: READY, RUNNING at the first state, an answer to each sample, the same again when
// its state comes again, and at an end of its own a last command that asks for zero volts.
TEST_F(OwnPositionLoopTest, AnswersEachSampleOnce) {
  OwnPositionLoop loop(bus_, clock_, config_, [this](const state_t& state, pressure_command_t* command) {
    ++asked_;
    command->pressure_ref = 100 * state.arm_angle;
  });
  loop.Poll();
  Deliver();
  EXPECT_THAT(states_, ElementsAre(process_status_t::READY));
  for (int64_t tick = 0; tick <= 6; ++tick) State(tick, tick);
  State(5, 5);
  ASSERT_EQ(commands_.size(), 3u);
  EXPECT_EQ(asked_, 2);
  EXPECT_EQ(commands_[1].tick, 5);
  EXPECT_EQ(commands_[1].sequence, 1);
  EXPECT_EQ(commands_[1].pressure_ref, 100 * (0.01 * 5));
  EXPECT_EQ(commands_[2].sequence, 1);
  EXPECT_FALSE(loop.finished());
  EXPECT_EQ(loop.Finish(), 0);
  Deliver();
  ASSERT_EQ(commands_.size(), 4u);
  EXPECT_TRUE(commands_[3].open_loop);
  EXPECT_EQ(commands_[3].voltage, 0);
  EXPECT_EQ(commands_[3].tick, 6);
  EXPECT_THAT(states_,
              ElementsAre(process_status_t::READY, process_status_t::RUNNING, process_status_t::DONE));
}

// Tests that a sample that later states have overtaken is answered, and that a number that was seen already,
// on a tick beyond all that was, is not: every good state after it would be an old one.
TEST_F(OwnPositionLoopTest, OvertakenSamplesAndForgedOnes) {
  OwnPositionLoop loop(bus_, clock_, config_, [this](const state_t&, pressure_command_t*) { ++asked_; });
  for (const int64_t tick : {0, 1, 2, 3, 4, 6, 7}) State(tick, tick);
  ASSERT_EQ(asked_, 1);
  State(5, 5);
  EXPECT_EQ(asked_, 2);
  EXPECT_EQ(commands_.back().tick, 5);
  State(1000000, 3);
  EXPECT_EQ(asked_, 2);
  EXPECT_EQ(commands_.back().tick, 5);
  for (const int64_t tick : {8, 9, 10}) State(tick, tick);
  EXPECT_EQ(commands_.back().tick, 10);
  EXPECT_EQ(loop.participant().statistics().Total(clock_.Now()).missed_deadlines, 0);
}

// Tests that the arm's reference is published before each answer, and not again with a repeated one.
TEST_F(OwnPositionLoopTest, PublishesItsReference) {
  std::vector<arm_reference_t> references;
  std::vector<size_t> commands_before;
  bus_.Subscribe<arm_reference_t>("HYDRO_ARM_REFERENCE", [&](const arm_reference_t& reference) {
    references.push_back(reference);
    commands_before.push_back(commands_.size());
  });
  OwnPositionLoop loop(
      bus_, clock_, config_, [](const state_t&, pressure_command_t*) {},
      [](const state_t& state) { return 2 * state.arm_angle; });
  for (int64_t tick = 0; tick <= 5; ++tick) State(tick, tick);
  State(5, 5);
  ASSERT_EQ(references.size(), 2u);
  EXPECT_THAT(commands_before, ElementsAre(0u, 1u));
  EXPECT_EQ(references[1].tick, 5);
  EXPECT_EQ(references[1].sequence, 1);
  EXPECT_EQ(references[1].session, loop.participant().session());
  EXPECT_EQ(references[1].signal, arm_reference_t::ARM_ANGLE);
  EXPECT_EQ(references[1].value, 0.1);
}

// Tests that a plant that begins anew is followed from its first sample on.
TEST_F(OwnPositionLoopTest, FollowsAPlantThatBeginsAnew) {
  OwnPositionLoop loop(bus_, clock_, config_, [this](const state_t&, pressure_command_t*) { ++asked_; });
  for (int64_t tick = 0; tick <= 10; ++tick) State(tick, tick);
  EXPECT_EQ(asked_, 3);
  clock_.AdvanceTo(clock_.Now() + std::chrono::seconds(10));
  state_t state{};
  state.session = 78;
  bus_.Publish("HYDRO_STATE", state);
  Deliver();
  EXPECT_EQ(asked_, 4);
  EXPECT_EQ(commands_.back().tick, 0);
}

// Tests that the end of the run is heard and needs no last command.
TEST_F(OwnPositionLoopTest, EndsWithTheRun) {
  OwnPositionLoop loop(bus_, clock_, config_, [](const state_t&, pressure_command_t*) {});
  State(0, 0);
  stop_t stop{};
  stop.addressee = 77;
  stop.session = 77;
  bus_.Publish("HYDRO_STOP", stop);
  Deliver();
  EXPECT_TRUE(loop.finished());
  EXPECT_EQ(loop.Finish(), 0);
  Deliver();
  EXPECT_EQ(commands_.size(), 1u);
}

}  // namespace
}  // namespace hydro::process
