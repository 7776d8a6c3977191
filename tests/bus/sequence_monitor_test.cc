#include "bus/sequence_monitor.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace hydro::bus {
namespace {

using namespace std::chrono_literals;
using Verdict = SequenceMonitor::Verdict;

struct Step {
  int64_t session;
  int64_t sequence;
  std::chrono::milliseconds at;
  Verdict verdict;
  int64_t gap;
};

void Check(const std::vector<Step>& steps, SequenceMonitor* monitor) {
  for (size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    EXPECT_EQ(monitor->Observe(step.session, step.sequence, Clock::TimePoint(step.at)), step.verdict)
        << "step " << i;
    EXPECT_EQ(monitor->gap(), step.gap) << "step " << i;
  }
}

// Tests that gaps are counted, that duplicates and old messages are refused, and that the first message may
// have any number.
TEST(SequenceMonitorTest, GapsAndDuplicates) {
  SequenceMonitor monitor(100ms);
  Check({{1, 10, 0ms, Verdict::kAccept, 0},
         {1, 11, 1ms, Verdict::kAccept, 0},
         {1, 11, 2ms, Verdict::kDuplicate, 0},
         {1, 14, 3ms, Verdict::kAccept, 2},
         {1, 12, 4ms, Verdict::kDuplicate, 0},
         {1, 15, 5ms, Verdict::kAccept, 0},
         {1, 115, 900ms, Verdict::kAccept, 99}},
        &monitor);
  EXPECT_EQ(monitor.lost(), 101);
  EXPECT_EQ(monitor.duplicates(), 2);
  EXPECT_EQ(monitor.restarts(), 0);
}

// Tests that another session counts as a second sender for as long as the first is alive.
TEST(SequenceMonitorTest, SecondSender) {
  SequenceMonitor monitor(100ms);
  EXPECT_FALSE(monitor.SecondSenderAlive(Clock::TimePoint(0ms)));
  Check({{1, 0, 0ms, Verdict::kAccept, 0},
         {2, 0, 50ms, Verdict::kSecondSender, 0},
         {1, 1, 60ms, Verdict::kAccept, 0},
         {2, 1, 160ms, Verdict::kSecondSender, 0}},  // exactly `alive` after the first: still alive
        &monitor);
  EXPECT_TRUE(monitor.SecondSenderAlive(Clock::TimePoint(260ms)));
  EXPECT_FALSE(monitor.SecondSenderAlive(Clock::TimePoint(261ms)));
  EXPECT_EQ(monitor.lost(), 0);
}

// Tests that another session after a silence is a restart, whatever its numbers, and is followed from then
// on.
TEST(SequenceMonitorTest, Restart) {
  SequenceMonitor monitor(100ms);
  Check({{1, 7, 0ms, Verdict::kAccept, 0},
         {2, 5, 90ms, Verdict::kSecondSender, 0},
         {2, 6, 101ms, Verdict::kRestarted, 0},
         {2, 7, 102ms, Verdict::kAccept, 0},
         {1, 8, 103ms, Verdict::kSecondSender, 0}},
        &monitor);
  EXPECT_EQ(monitor.restarts(), 1);
  EXPECT_EQ(monitor.lost(), 0);
}

// Tests that after a takeover nobody is a second sender any more.
TEST(SequenceMonitorTest, TakeoverEndsTheSecondSender) {
  SequenceMonitor monitor(100ms);
  Check({{1, 0, 0ms, Verdict::kAccept, 0},
         {2, 0, 90ms, Verdict::kSecondSender, 0},
         {2, 1, 110ms, Verdict::kRestarted, 0}},
        &monitor);
  EXPECT_FALSE(monitor.SecondSenderAlive(Clock::TimePoint(110ms)));
}

// Tests that a log played again after a silence is a restart, and that a repeated message is not, however
// late.
TEST(SequenceMonitorTest, PlayedAgain) {
  SequenceMonitor monitor(100ms);
  Check({{1, 0, 0ms, Verdict::kAccept, 0},
         {1, 1, 1ms, Verdict::kAccept, 0},
         {1, 1, 500ms, Verdict::kDuplicate, 0},
         {1, 0, 501ms, Verdict::kDuplicate, 0},
         {1, 0, 700ms, Verdict::kRestarted, 0},
         {1, 1, 701ms, Verdict::kAccept, 0}},
        &monitor);
}

// Tests that a tick that goes back is refused even if the sequence goes on, and that a restart clears this.
TEST(SequenceMonitorTest, TicksGoingBack) {
  SequenceMonitor monitor(100ms);
  const auto observe = [&](int64_t session, int64_t sequence, int64_t tick, std::chrono::milliseconds at) {
    return monitor.Observe(session, sequence, tick, Clock::TimePoint(at));
  };
  EXPECT_EQ(observe(1, 0, 50, 0ms), Verdict::kAccept);
  EXPECT_EQ(observe(1, 1, 50, 1ms), Verdict::kAccept);
  EXPECT_EQ(observe(1, 2, 49, 2ms), Verdict::kDuplicate);
  EXPECT_EQ(observe(1, 3, 51, 3ms), Verdict::kAccept);
  EXPECT_EQ(observe(2, 0, 1, 4ms), Verdict::kSecondSender);
  EXPECT_EQ(observe(2, 1, 2, 400ms), Verdict::kRestarted);
  EXPECT_EQ(observe(2, 2, 3, 401ms), Verdict::kAccept);
  EXPECT_EQ(monitor.lost(), 0);
}

// Tests that a message with a far number, which was not the sender's own, deafens nobody for good: the sender
// is followed again once it has gone on behind that message for `alive`.
TEST(SequenceMonitorTest, FarNumber) {
  constexpr int64_t kFar = int64_t{1} << 62;
  SequenceMonitor monitor(100ms);
  Check({{1, 5, 0ms, Verdict::kAccept, 0},
         {1, kFar, 10ms, Verdict::kAccept, kFar - 6},
         {1, 6, 20ms, Verdict::kDuplicate, 0},
         {1, 7, 60ms, Verdict::kDuplicate, 0},
         {1, 8, 110ms, Verdict::kDuplicate, 0},
         {1, 9, 111ms, Verdict::kRestarted, 0},
         {1, 10, 112ms, Verdict::kAccept, 0}},
        &monitor);
}

// Tests that the sender must go on: one old message, however often it is repeated, is never followed.
TEST(SequenceMonitorTest, OldMessageRepeated) {
  SequenceMonitor monitor(100ms);
  EXPECT_EQ(monitor.Observe(1, 5, Clock::TimePoint(0ms)), Verdict::kAccept);
  for (int i = 1; i < 20; ++i) {
    EXPECT_EQ(monitor.Observe(1, 4, Clock::TimePoint(i * 20ms)), Verdict::kDuplicate);
  }
  EXPECT_EQ(monitor.Observe(1, 6, Clock::TimePoint(401ms)), Verdict::kAccept);
}

// Tests that where ticks are known, an old message of the same sender is old however long the silence was:
// lockstep may wait that long. Another sender begins where it likes.
TEST(SequenceMonitorTest, OldTickAfterASilence) {
  SequenceMonitor monitor(100ms);
  const auto observe = [&](int64_t session, int64_t sequence, int64_t tick, std::chrono::milliseconds at) {
    return monitor.Observe(session, sequence, tick, Clock::TimePoint(at));
  };
  EXPECT_EQ(observe(1, 10, 50, 0ms), Verdict::kAccept);
  EXPECT_EQ(observe(1, 3, 43, 500ms), Verdict::kDuplicate);
  EXPECT_EQ(observe(1, 4, 44, 1000ms), Verdict::kDuplicate);
  EXPECT_EQ(observe(1, 11, 51, 1001ms), Verdict::kAccept);
  EXPECT_EQ(observe(2, 0, 40, 2000ms), Verdict::kRestarted);
}

// Tests that of two other senders one is not forgotten because the other takes over.
TEST(SequenceMonitorTest, ThirdSender) {
  SequenceMonitor monitor(100ms);
  Check({{1, 0, 0ms, Verdict::kAccept, 0},
         {2, 0, 20ms, Verdict::kSecondSender, 0},
         {3, 0, 90ms, Verdict::kSecondSender, 0},
         {2, 1, 101ms, Verdict::kRestarted, 0}},
        &monitor);
  EXPECT_TRUE(monitor.SecondSenderAlive(Clock::TimePoint(190ms)));
  EXPECT_FALSE(monitor.SecondSenderAlive(Clock::TimePoint(191ms)));
}

// Tests that a second sender is not forgotten because the first is followed again.
TEST(SequenceMonitorTest, SecondSenderOutlastsAFarNumber) {
  SequenceMonitor monitor(100ms);
  Check({{1, 5, 0ms, Verdict::kAccept, 0},
         {1, 1000, 10ms, Verdict::kAccept, 994},
         {1, 6, 20ms, Verdict::kDuplicate, 0},
         {2, 0, 100ms, Verdict::kSecondSender, 0},
         {1, 7, 111ms, Verdict::kRestarted, 0}},
        &monitor);
  EXPECT_TRUE(monitor.SecondSenderAlive(Clock::TimePoint(112ms)));
  EXPECT_FALSE(monitor.SecondSenderAlive(Clock::TimePoint(201ms)));
}

// Tests that forged sequence numbers, as far apart as possible, are still counted sensibly.
TEST(SequenceMonitorTest, ExtremeNumbers) {
  constexpr int64_t kLowest = std::numeric_limits<int64_t>::min();
  constexpr int64_t kHighest = std::numeric_limits<int64_t>::max();
  SequenceMonitor monitor(100ms);
  EXPECT_EQ(monitor.Observe(1, kLowest, Clock::TimePoint(0ms)), Verdict::kAccept);
  EXPECT_EQ(monitor.Observe(1, kHighest, Clock::TimePoint(1ms)), Verdict::kAccept);
  EXPECT_GE(monitor.gap(), kHighest - 1);
  EXPECT_EQ(monitor.Observe(1, 0, Clock::TimePoint(500ms)), Verdict::kRestarted);
  EXPECT_EQ(monitor.Observe(1, kHighest, Clock::TimePoint(501ms)), Verdict::kAccept);
  EXPECT_EQ(monitor.lost(), kHighest);
}

}  // namespace
}  // namespace hydro::bus
