#include "bus/session.h"

#include <gtest/gtest.h>

#include <set>

namespace hydro::bus {
namespace {

// Tests that sessions differ and are never 0 on a wall clock, and are always 0 on a simulated one.
TEST(SessionTest, RandomOnAWallClock) {
  std::set<int64_t> sessions;
  for (int i = 0; i < 1000; ++i) sessions.insert(SessionOn(WallClock()));
  EXPECT_EQ(sessions.size(), 1000u);
  EXPECT_FALSE(sessions.contains(0));
  EXPECT_EQ(SessionOn(SimulatedClock()), 0);
}

}  // namespace
}  // namespace hydro::bus
