#include "process/timing/round_trip_monitor.h"

#include <gtest/gtest.h>

namespace hydro::timing {
namespace {

using namespace std::chrono_literals;

constexpr bus::Clock::TimePoint kStart{5s};

// Tests that the first answer to each tick is measured from the first time its state was sent, and nothing
// else is.
TEST(RoundTripMonitorTest, FirstAnswerFromFirstSending) {
  RoundTripMonitor monitor;
  EXPECT_FALSE(monitor.OnAnswer(0, kStart));  // nothing was sent
  monitor.OnSent(0, kStart);
  monitor.OnSent(1, kStart + 1ms);
  monitor.OnSent(0, kStart + 2ms);  // again, as in lockstep
  EXPECT_EQ(monitor.OnAnswer(0, kStart + 5ms), 5ms);
  EXPECT_FALSE(monitor.OnAnswer(0, kStart + 6ms));
  EXPECT_EQ(monitor.OnAnswer(1, kStart + 6ms), 5ms);
  EXPECT_FALSE(monitor.OnAnswer(2, kStart + 6ms));
  EXPECT_FALSE(monitor.OnAnswer(-1, kStart + 6ms));
}

// Tests that an answer to a tick that has been forgotten is not taken for one to a newer tick.
TEST(RoundTripMonitorTest, ForgetsOldTicks) {
  RoundTripMonitor monitor;
  for (int64_t tick = 0; tick <= RoundTripMonitor::kRemembered; ++tick)
    monitor.OnSent(tick, kStart + tick * 1ms);
  EXPECT_FALSE(monitor.OnAnswer(0, kStart + 2s));
  EXPECT_EQ(monitor.OnAnswer(RoundTripMonitor::kRemembered, kStart + 1026ms), 2ms);
  EXPECT_EQ(monitor.OnAnswer(1, kStart + 2ms), 1ms);
}

}  // namespace
}  // namespace hydro::timing
