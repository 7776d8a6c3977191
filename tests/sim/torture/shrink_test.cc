#include <gtest/gtest.h>

#include <algorithm>

#include "sim/torture/run_schedule.h"

namespace hydro::torture {
namespace {

Schedule WithCrashAmong(int others) {
  Schedule schedule;
  schedule.faults_until_s = 20;
  for (int i = 0; i < others; ++i) {
    schedule.injections.push_back({1.0 + i, FaultKind::kLoss, -1, 0.5, 0.5, 1});
  }
  schedule.injections.insert(schedule.injections.begin() + others / 2,
                             {5.5, FaultKind::kCrash, 1, 1.6, 0, 1});
  return schedule;
}

bool HasLongCrash(const Schedule& schedule) {
  return std::any_of(schedule.injections.begin(), schedule.injections.end(), [](const Injection& injection) {
    return injection.kind == FaultKind::kCrash && injection.duration_s >= 0.3;
  });
}

TEST(ShrinkTest, LeavesOnlyWhatFails) {
  const Schedule shrunk = Shrink(WithCrashAmong(11), HasLongCrash);
  ASSERT_EQ(shrunk.injections.size(), 1u);
  EXPECT_EQ(shrunk.injections[0].kind, FaultKind::kCrash);
  EXPECT_DOUBLE_EQ(shrunk.injections[0].duration_s, 0.4);
  EXPECT_DOUBLE_EQ(shrunk.injections[0].at_s, 0.5);
  EXPECT_LT(shrunk.faults_until_s, 1.1);
}

TEST(ShrinkTest, RunsNoMoreOftenThanAllowed) {
  int runs = 0;
  Shrink(
      WithCrashAmong(11),
      [&](const Schedule& schedule) {
        ++runs;
        return HasLongCrash(schedule);
      },
      7);
  EXPECT_EQ(runs, 7);
}

TEST(ShrinkTest, KeepsWhatAlwaysFails) {
  EXPECT_TRUE(Shrink(WithCrashAmong(3), [](const Schedule&) { return true; }).injections.empty());
}

}  // namespace
}  // namespace hydro::torture
