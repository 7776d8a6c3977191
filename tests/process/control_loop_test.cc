#include "process/control_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/process/loop_fixture.h"

namespace hydro::process {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Writes down what the skeleton asks of it.
class NotedLoop : public ControlLoop {
 public:
  NotedLoop(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config, int64_t interval)
      : ControlLoop(bus, clock, config, "position_ctrl", interval) {
    participant().Announce(process_status_t::READY);
  }
  using ControlLoop::participant;

  int Finish() override { return participant().Leave(); }

  std::vector<std::string> notes;
  bool waits = false;   // for the answer to a proposed change
  bool has_all = true;  // that an answer needs
  int64_t missed() const {
    return participant().statistics().Total(participant().clock().Now()).missed_deadlines;
  }

 private:
  void BeginAnew() override { notes.push_back("anew"); }
  bool MustWait(const state_t&) override { return waits; }
  void Observe(const state_t& state) override {
    notes.push_back("state " + std::to_string(state.tick) + " after " + std::to_string(participant().tick()));
  }
  bool Answer(const state_t& state, bus::Clock::TimePoint) override {
    notes.push_back("answer " + std::to_string(state.tick));
    if (!has_all) return false;
    CountIntervals(state.tick);
    set_answered(state.tick);
    return true;
  }
  void AnswerAgain() override { notes.push_back("again " + std::to_string(answered())); }
  void OnSilence(bus::Clock::Duration) override { notes.push_back("silence"); }
};

class ControlLoopTest : public LoopTest {};

// Tests that each state is observed before its tick counts, and that those which are due are answered.
TEST_F(ControlLoopTest, AnswersWhatIsDue) {
  NotedLoop loop(bus_, clock_, config_, 2);
  State(0, 0);
  State(1, 1);
  State(2, 2);
  EXPECT_THAT(loop.notes,
              ElementsAre("state 0 after -1", "answer 0", "state 1 after 0", "state 2 after 1", "answer 2"));
  EXPECT_EQ(loop.participant().state(), process_status_t::RUNNING);
  EXPECT_EQ(loop.participant().run(), 77);
  EXPECT_EQ(loop.missed(), 0);
  State(8, 3);
  EXPECT_EQ(loop.missed(), 2) << "4 and 6";
}

// Tests that a state that comes again is answered again, one that others overtook is answered, and a forged
// one is not.
TEST_F(ControlLoopTest, StatesThatComeAgain) {
  NotedLoop loop(bus_, clock_, config_, 5);
  for (const int64_t tick : {0, 1, 2, 3, 4, 6}) State(tick, tick);
  loop.notes.clear();
  State(0, 0);
  State(5, 5);
  State(5, 5);
  State(1000, 3);
  EXPECT_THAT(loop.notes, ElementsAre("again 0", "answer 5", "again 5"));
  EXPECT_EQ(loop.participant().tick(), 6);
}

// Tests that another plant, and the same record from its beginning, begin anew; a second plant beside the
// first does not.
TEST_F(ControlLoopTest, BeginsAnew) {
  config_.limits.stale_input_s = 0.05;
  NotedLoop loop(bus_, clock_, config_, 1);
  State(0, 0);
  State(1, 1);
  loop.notes.clear();
  State(0, 2);
  EXPECT_THAT(loop.notes, ElementsAre("anew", "state 0 after 1", "answer 0"));
  loop.notes.clear();
  State(7, 0, 78);
  EXPECT_TRUE(loop.notes.empty()) << "while the first one is heard, a second sender is not followed";
  clock_.AdvanceTo(clock_.Now() + std::chrono::milliseconds(60));
  State(0, 0, 79);
  EXPECT_THAT(loop.notes, ElementsAre("anew", "state 0 after 0", "answer 0"));
}

// Tests that a state which must wait is as if it had not come, and that an answer that lacks something is
// none.
TEST_F(ControlLoopTest, WhatWaits) {
  NotedLoop loop(bus_, clock_, config_, 1);
  loop.waits = true;
  State(0, 0);
  EXPECT_TRUE(loop.notes.empty());
  EXPECT_EQ(loop.participant().tick(), -1);
  loop.waits = false;
  loop.has_all = false;
  State(1, 1);
  State(1, 1);
  EXPECT_THAT(loop.notes, ElementsAre("state 1 after -1", "answer 1")) << "nothing to repeat";
}

// Tests that a silent plant is the loop's to judge in real time, and ends the run in lockstep, once.
TEST_F(ControlLoopTest, Silence) {
  NotedLoop loop(bus_, clock_, config_, 1);
  loop.Poll();
  EXPECT_TRUE(loop.notes.empty()) << "no run yet";
  State(0, 0);
  loop.notes.clear();
  loop.Poll();
  EXPECT_THAT(loop.notes, ElementsAre("silence"));

  config_.time.mode = settings::TimeMode::kLockstep;
  config_.time.stall_timeout_s = 1;
  bus::InProcessBus bus{&clock_};
  NotedLoop locked(bus, clock_, config_, 1);
  state_t state{};
  state.session = 5;
  bus.Publish("HYDRO_STATE", state);
  clock_.AdvanceTo(clock_.Now() + std::chrono::milliseconds(1));
  while (bus.HandleUntil(clock_.Now()) > 0) {
  }
  clock_.AdvanceTo(clock_.Now() + std::chrono::milliseconds(1300));
  locked.Poll();
  EXPECT_FALSE(locked.finished()) << "the plant itself names a late participant first";
  clock_.AdvanceTo(clock_.Now() + std::chrono::milliseconds(200));
  locked.Poll();
  ASSERT_TRUE(locked.finished());
  EXPECT_THAT(locked.participant().stop()->reason,
              HasSubstr("the plant has sent no state for 1.5 s (last: tick 0)"));
  EXPECT_EQ(locked.Finish(), 1);
}

}  // namespace
}  // namespace hydro::process
