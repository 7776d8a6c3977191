#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "launch/logic/stop_sequence.h"

namespace hydro::launch {
namespace {

using Published = std::vector<std::pair<std::string, int>>;

// Tests that a stop is published three times at once and five times more, each when it is due, and then no
// more.
TEST(StopAnnouncerTest, RepeatsAsOftenAsItShould) {
  Published published;
  const bus::WallClock clock;
  StopAnnouncer announcer(
      clock, [&](const std::string& reason, int exit_code) { published.emplace_back(reason, exit_code); });
  EXPECT_FALSE(announcer.announced());
  EXPECT_FALSE(announcer.repeating());
  announcer.Repeat();
  EXPECT_TRUE(published.empty());

  announcer.Announce("stopped by SIGINT", 0);
  EXPECT_TRUE(announcer.announced());
  EXPECT_EQ(published, Published(3, {"stopped by SIGINT", 0}));
  for (size_t repeats = 1; repeats <= 5; ++repeats) {
    ASSERT_TRUE(announcer.repeating());
    std::this_thread::sleep_until(announcer.next_repeat());
    announcer.Repeat();
    EXPECT_EQ(published.size(), 3 + repeats);
  }
  EXPECT_FALSE(announcer.repeating());
  std::this_thread::sleep_until(announcer.next_repeat());
  announcer.Repeat();
  EXPECT_EQ(published, Published(8, {"stopped by SIGINT", 0}));
}

// Tests that a later announcement replaces the one before it and restarts its repetitions.
TEST(StopAnnouncerTest, TheLatestAnnouncementCounts) {
  Published published;
  const bus::WallClock clock;
  StopAnnouncer announcer(
      clock, [&](const std::string& reason, int exit_code) { published.emplace_back(reason, exit_code); });
  announcer.Announce("stopped by SIGINT", 0);
  announcer.Announce("plant: arm_angle_limit", 1);
  std::this_thread::sleep_until(announcer.next_repeat());
  announcer.Repeat();
  ASSERT_EQ(published.size(), 7u);
  EXPECT_EQ(published.back(), (std::pair<std::string, int>("plant: arm_angle_limit", 1)));
  EXPECT_TRUE(announcer.repeating());
}

}  // namespace
}  // namespace hydro::launch
