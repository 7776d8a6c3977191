#include "process/refusal_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hydro::process {
namespace {

using namespace std::chrono_literals;
using News = RefusalWatch::News;
using testing::HasSubstr;
using testing::Not;

// Tests that a burst is reported once when it begins and once, with the total refused, a second later.
TEST(RefusalWatchTest, BeginsAndEnds) {
  RefusalWatch watch;
  bus::RefusedMessages refused;
  bus::Clock::TimePoint now{1h};
  EXPECT_EQ(watch.Observe(refused, now), News::kNone);
  refused.unsealed = 2;
  refused.last_channel = "HYDRO_MOTOR_COMMAND";
  EXPECT_EQ(watch.Observe(refused, now), News::kBegins);
  EXPECT_EQ(watch.count(), 2);
  EXPECT_THAT(watch.Text(), HasSubstr("2 messages"));
  for (int i = 0; i < 10; ++i) {
    now += 900ms;
    refused.wrong_seal += 1;
    EXPECT_EQ(watch.Observe(refused, now), News::kNone);
  }
  EXPECT_EQ(watch.Observe(refused, now + 999ms), News::kNone);
  EXPECT_EQ(watch.Observe(refused, now + 1s), News::kEnds);
  EXPECT_EQ(watch.count(), 12);
  EXPECT_THAT(watch.Text(), HasSubstr("2 without a seal, 10 sealed with another key"));
  EXPECT_THAT(watch.Text(), HasSubstr("HYDRO_MOTOR_COMMAND"));
  EXPECT_EQ(watch.Observe(refused, now + 10s), News::kNone);
}

// Tests that a second burst is counted afresh.
TEST(RefusalWatchTest, CountsEachBurst) {
  RefusalWatch watch;
  bus::RefusedMessages refused;
  bus::Clock::TimePoint now{1h};
  refused.unsealed = 5;
  watch.Observe(refused, now);
  EXPECT_EQ(watch.Observe(refused, now + 2s), News::kEnds);
  refused.repeated = 1;
  EXPECT_EQ(watch.Observe(refused, now + 3s), News::kBegins);
  EXPECT_EQ(watch.count(), 1);
  EXPECT_THAT(watch.Text(), HasSubstr("1 message not"));
  EXPECT_THAT(watch.Text(), Not(HasSubstr("without a seal")));
  EXPECT_THAT(watch.Text(), HasSubstr("1 played again"));
}

}  // namespace
}  // namespace hydro::process
