#include "process/timing/fixed_rate_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/time.h>

#include <csignal>

#include "bus/in_process_bus.h"
#include "hydro/state_t.hpp"

namespace hydro::timing {
namespace {

using namespace std::chrono_literals;

class FixedRateLoopTest : public testing::Test {
 protected:
  bus::SimulatedClock clock_;
  bus::InProcessBus bus_{&clock_};
  LoopStatistics statistics_{"plant", "", 0, clock_.Now()};
};

// Tests that 10 simulated seconds at 1 kHz are 10001 ticks, that of the start included, each exactly when it
// is due.
TEST_F(FixedRateLoopTest, CountsExactlyOnASimulatedClock) {
  FixedRateLoop loop(bus_, clock_, 1ms, statistics_);
  int ticks = 1;
  while (clock_.Now() < bus::Clock::TimePoint(10s)) {
    ASSERT_EQ(loop.Wait(), 1);
    ASSERT_EQ(clock_.Now(), bus::Clock::TimePoint(ticks * 1ms));
    ++ticks;
  }
  EXPECT_EQ(ticks, 10'001);
  EXPECT_EQ(loop.tick(), 10'000);
  EXPECT_EQ(loop.skipped(), 0);
  const loop_statistics_t total = statistics_.Total(clock_.Now());
  EXPECT_EQ(total.cycles, 10'000);
  EXPECT_EQ(total.period_max_us, 1000);
  EXPECT_EQ(total.latency_max_us, 0);
}

// Tests that a period that is no whole number of ns does not drift: 3 kHz gives 3 million ticks in 1000 s, to
// the ns.
TEST_F(FixedRateLoopTest, NeverDrifts) {
  FixedRateLoop loop(bus_, clock_, std::chrono::duration<double>(1.0 / 3000), statistics_);
  for (int i = 0; i < 3'000'000; ++i) ASSERT_EQ(loop.Wait(), 1);
  EXPECT_EQ(clock_.Now(), bus::Clock::TimePoint(1000s));
}

// Tests that a late caller learns how many ticks have passed, and that the next deadline is on the old grid.
TEST_F(FixedRateLoopTest, CountsSkippedTicks) {
  FixedRateLoop loop(bus_, clock_, 1ms, statistics_);
  EXPECT_EQ(loop.Wait(), 1);
  clock_.AdvanceTo(bus::Clock::TimePoint(4500us));  // the work took 3.5 ms
  EXPECT_EQ(loop.Wait(), 3);                        // ticks 2, 3 and 4
  EXPECT_EQ(clock_.Now(), bus::Clock::TimePoint(4500us));
  EXPECT_EQ(loop.tick(), 4);
  EXPECT_EQ(loop.skipped(), 2);
  EXPECT_EQ(loop.Wait(), 1);
  EXPECT_EQ(clock_.Now(), bus::Clock::TimePoint(5ms));
  clock_.AdvanceTo(bus::Clock::TimePoint(7ms));  // exactly two ticks on
  EXPECT_EQ(loop.Wait(), 2);
  const loop_statistics_t total = statistics_.Total(clock_.Now());
  EXPECT_EQ(total.missed_deadlines, 3);
  EXPECT_EQ(total.cycles, 4);
  EXPECT_DOUBLE_EQ(total.latency_max_us, 2500);
}

// Tests that a late caller skips no tick beyond the last: nobody would count it but this loop.
TEST_F(FixedRateLoopTest, EndsAtTheLastTick) {
  FixedRateLoop loop(bus_, clock_, 1ms, statistics_, 5);
  EXPECT_EQ(loop.Wait(), 1);
  clock_.AdvanceTo(bus::Clock::TimePoint(9500us));
  EXPECT_EQ(loop.Wait(), 4);  // ticks 2 to 5
  EXPECT_EQ(loop.tick(), 5);
  EXPECT_EQ(loop.skipped(), 3);
  EXPECT_EQ(statistics_.Total(clock_.Now()).missed_deadlines, 3);
}

// Tests that messages are handled before the tick, even by a loop that is always late.
TEST_F(FixedRateLoopTest, HandlesMessagesWhileWaiting) {
  int states = 0;
  bus_.Subscribe<state_t>("STATE", [&](const state_t&) { ++states; });
  FixedRateLoop loop(bus_, clock_, 1ms, statistics_);
  for (int i = 1; i <= 10; ++i) {
    bus_.Publish("STATE", state_t{});
    if (i > 5) clock_.AdvanceTo(clock_.Now() + 2ms);
    loop.Wait();
    EXPECT_EQ(states, i);
  }
}

// Tests that a loop on the wall clock never returns before its tick is due and accounts for every tick.
TEST_F(FixedRateLoopTest, WallClockTicksAreNeverEarly) {
  bus::WallClock wall;
  bus::InProcessBus bus(nullptr);
  const auto start = wall.Now();
  FixedRateLoop loop(bus, wall, 500us, statistics_);
  int64_t ticks = 0;
  while (ticks < 50) {
    ticks += loop.Wait();
    EXPECT_EQ(loop.tick(), ticks);
    EXPECT_GE(wall.Now(), start + ticks * 500us);
  }
  EXPECT_EQ(statistics_.Total(wall.Now()).missed_deadlines, loop.skipped());
}

void OnAlarm(int) {}

// Tests that a signal makes Wait() return 0, and that the tick then still comes.
TEST_F(FixedRateLoopTest, SignalEndsTheWait) {
  bus::WallClock wall;
  bus::InProcessBus bus(nullptr);
  struct sigaction action {};
  action.sa_handler = OnAlarm;
  sigaction(SIGALRM, &action, nullptr);
  itimerval repeatedly{};
  repeatedly.it_value.tv_usec = repeatedly.it_interval.tv_usec = 10'000;
  FixedRateLoop loop(bus, wall, 100s, statistics_);
  setitimer(ITIMER_REAL, &repeatedly, nullptr);
  EXPECT_EQ(loop.Wait(), 0);
  EXPECT_EQ(loop.tick(), 0);
  const itimerval off{};
  setitimer(ITIMER_REAL, &off, nullptr);
}

// Tests that a period of zero, a negative one and NaN are refused.
TEST_F(FixedRateLoopTest, RefusesBadPeriods) {
  using Period = std::chrono::duration<double, std::nano>;
  for (const double ns : {0.0, -1e6, std::nan("")}) {
    EXPECT_THROW(FixedRateLoop(bus_, clock_, Period(ns), statistics_), std::invalid_argument);
  }
}

}  // namespace
}  // namespace hydro::timing
