#include "process/timing/round_trip_monitor.h"

#include <gtest/gtest.h>

namespace hydro::timing {
namespace {

using namespace std::chrono_literals;

constexpr bus::Clock::TimePoint kFirstSent{5s};

// Tests that the first answer to each tick is measured from the first time its state was sent, and nothing
// else is.
TEST(RoundTripMonitorTest, FirstAnswerFromFirstSending) {
  RoundTripMonitor monitor;
  EXPECT_FALSE(monitor.OnAnswer(0, kFirstSent));  // nothing was sent
  monitor.OnSent(0, kFirstSent);
  monitor.OnSent(1, kFirstSent + 1ms);
  monitor.OnSent(0, kFirstSent + 2ms);  // again, as in lockstep
  EXPECT_EQ(monitor.OnAnswer(0, kFirstSent + 5ms), 5ms);
  EXPECT_FALSE(monitor.OnAnswer(0, kFirstSent + 6ms));
  EXPECT_EQ(monitor.OnAnswer(1, kFirstSent + 6ms), 5ms);
  EXPECT_FALSE(monitor.OnAnswer(2, kFirstSent + 6ms));
  EXPECT_FALSE(monitor.OnAnswer(-1, kFirstSent + 6ms));
}

// Tests that an answer to a tick that has been forgotten is not taken for one to a newer tick.
TEST(RoundTripMonitorTest, ForgetsOldTicks) {
  RoundTripMonitor monitor;
  for (int64_t tick = 0; tick <= RoundTripMonitor::kRemembered; ++tick)
    monitor.OnSent(tick, kFirstSent + tick * 1ms);
  EXPECT_FALSE(monitor.OnAnswer(0, kFirstSent + 2s));
  EXPECT_EQ(monitor.OnAnswer(RoundTripMonitor::kRemembered, kFirstSent + 1026ms), 2ms);
  EXPECT_EQ(monitor.OnAnswer(1, kFirstSent + 2ms), 1ms);
}

}  // namespace
}  // namespace hydro::timing
