#include "process/timing/followed_rate_loop.h"

#include <gtest/gtest.h>

#include <random>

namespace hydro::timing {
namespace {

using namespace std::chrono_literals;

class FollowedRateLoopTest : public testing::Test {
 protected:
  static bus::Clock::TimePoint At(double ms) {
    return bus::Clock::TimePoint(std::chrono::nanoseconds(std::llround(1e6 * ms)));
  }

  // The ticks that are due when sample `number` arrives at `ms`, those before it included that were due
  // without one.
  int64_t Arrives(int64_t number, double ms) {
    int64_t ticks = 0;
    while (loop_.deadline() < At(ms)) ticks += loop_.Elapsed(loop_.deadline(), std::nullopt);
    return ticks + loop_.Elapsed(At(ms), number);
  }

  bus::SimulatedClock clock_;
  LoopStatistics statistics_{"driver", "", 0, clock_.Now()};
  FollowedRateLoop loop_{clock_, 1ms, statistics_};
};

// Tests that each sample begins one tick, at the moment it comes, also where the device's clock is 200 ppm
// off, either way.
TEST_F(FollowedRateLoopTest, FollowsTheDevicesClock) {
  for (const double period : {0.9998, 1.0, 1.0002}) {
    FollowedRateLoop loop(clock_, 1ms, statistics_);
    int64_t ticks = 0;
    for (int k = 1; k <= 20'000; ++k) {
      const auto arrival = At(0.3 + k * period);
      ASSERT_GT(loop.deadline(), arrival) << k;
      const int64_t elapsed = loop.Elapsed(arrival, k);
      EXPECT_EQ(elapsed, 1) << k;
      EXPECT_EQ(loop.woke(), arrival);
      ticks += elapsed;
    }
    EXPECT_EQ(ticks, 20'000);
    EXPECT_EQ(loop.skipped(), 0);
  }
}

// Tests that samples which come at uneven times begin one tick each all the same: late ones are waited for up
// to half a period.
TEST_F(FollowedRateLoopTest, BearsUnevenArrivals) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(0, 0.4);
  for (int k = 1; k <= 20'000; ++k) ASSERT_EQ(Arrives(k, k + jitter(random)), 1) << k;
}

// Tests a lost sample: its tick begins half a period late, and the one after it when its own sample comes.
TEST_F(FollowedRateLoopTest, GoesOnWithoutASample) {
  for (int k = 1; k <= 100; ++k) ASSERT_EQ(Arrives(k, k), 1);
  EXPECT_EQ(loop_.deadline(), At(101.5));
  EXPECT_EQ(loop_.Elapsed(At(101.4), std::nullopt), 0);
  EXPECT_EQ(loop_.Elapsed(At(101.5), std::nullopt), 1);
  EXPECT_EQ(loop_.late(), 500us);
  EXPECT_EQ(Arrives(102, 102), 1);
}

// Tests a sample that comes after its tick had begun without it: it is not counted twice.
TEST_F(FollowedRateLoopTest, CountsALateSampleOnce) {
  for (int k = 1; k <= 100; ++k) ASSERT_EQ(Arrives(k, k), 1);
  EXPECT_EQ(Arrives(101, 101.7), 1);
  EXPECT_EQ(loop_.woke(), At(101.5));
  EXPECT_EQ(Arrives(102, 102), 1);
  EXPECT_EQ(loop_.woke(), At(102));
}

// Tests a process that stood still: the newest sample tells how many ticks have passed.
TEST_F(FollowedRateLoopTest, CountsWhatItSleptThrough) {
  for (int k = 1; k <= 100; ++k) ASSERT_EQ(Arrives(k, k), 1);
  EXPECT_EQ(loop_.Elapsed(At(110.4), 110), 10);
  EXPECT_EQ(loop_.skipped(), 9);
  EXPECT_EQ(Arrives(111, 111), 1);
  EXPECT_EQ(statistics_.Total(At(111)).missed_deadlines, 9);
}

// Tests that a device which falls silent leaves the ticks to this clock, and takes the lead again when it is
// back, with whatever count.
TEST_F(FollowedRateLoopTest, OutlivesTheDevice) {
  for (int k = 1; k <= 100; ++k) ASSERT_EQ(Arrives(k, k), 1);
  int64_t ticks = 100;
  while (loop_.deadline() < At(600.2)) {
    const auto deadline = loop_.deadline();
    ASSERT_EQ(loop_.Elapsed(deadline, std::nullopt), 1);
    ++ticks;
  }
  EXPECT_EQ(ticks, 599);
  for (int k = 0; k <= 100; ++k) ticks += Arrives(k + 5, 600.2 + k);  // it has begun anew
  EXPECT_NEAR(static_cast<double>(ticks), 700, 1);
  EXPECT_EQ(Arrives(106, 701.2), 1);
  EXPECT_EQ(loop_.woke(), At(701.2));
}

// Tests that a clock that is wrong by far does not make time: ticks are then those of this clock, but for the
// half percent by which a device may lead.
TEST_F(FollowedRateLoopTest, BelievesNoWrongClock) {
  for (const double period : {0.5, 0.8, 1.5, 3.0}) {
    FollowedRateLoop loop(clock_, 1ms, statistics_);
    int64_t ticks = 0;
    double now = 0;
    for (int64_t k = 1; now < 3000; ++k) {
      now = static_cast<double>(k) * period;
      while (loop.deadline() < At(now)) {
        const auto deadline = loop.deadline();
        ticks += loop.Elapsed(deadline, std::nullopt);
      }
      ticks += loop.Elapsed(At(now), k == 500 ? k + 1'000'000'000'000 : k);
    }
    EXPECT_NEAR(static_cast<double>(ticks), 3000, 20) << period;
  }
}

// Tests that no tick beyond the last is counted.
TEST_F(FollowedRateLoopTest, EndsAtTheLastTick) {
  FollowedRateLoop loop(clock_, 1ms, statistics_, 5);
  EXPECT_EQ(loop.Elapsed(At(1), 1), 1);
  EXPECT_EQ(loop.Elapsed(At(9), 9), 4);
}

}  // namespace
}  // namespace hydro::timing
