#include "position_ctrl/plan_follower.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace hydro::position_ctrl {
namespace {

using ::testing::HasSubstr;

constexpr double kNone = std::numeric_limits<double>::infinity();

arm_plan_t Plan(int64_t session, int64_t sequence, const std::vector<double>& time,
                const std::vector<double>& angle, const std::vector<double>& speed) {
  arm_plan_t plan;
  plan.session = session;
  plan.sequence = sequence;
  plan.tick = -1;
  plan.count = static_cast<int32_t>(time.size());
  plan.time = time;
  plan.arm_angle = angle;
  plan.arm_speed = speed;
  plan.torque.assign(time.size(), 5);
  return plan;
}

// At 1 kHz, without delay.
PlanFollower Follower(double largest_speed = kNone) {
  return {0.1, {.timeout_s = 0.2, .delay_s = 0, .largest_speed = largest_speed, .largest_angle = 1}, 1000};
}

// Tests that the reference goes through the points with their speeds: a cubic's own points and speeds give
// that cubic.
TEST(PlanFollower, GoesThroughThePoints) {
  const auto angle = [](double t) { return 0.1 + 2 * t - 30 * t * t + 100 * t * t * t; };
  const auto speed = [](double t) { return 2 - 60 * t + 300 * t * t; };
  PlanFollower follower = Follower();
  std::vector<double> times{0, 0.03, 0.1}, angles, speeds;
  for (const double t : times) {
    angles.push_back(angle(t));
    speeds.push_back(speed(t));
  }
  ASSERT_EQ(follower.Take(Plan(1, 0, times, angles, speeds), 0), "");
  for (int64_t tick = 0; tick < 100; tick += 5) {
    const PlannedPoint point = follower.At(tick);
    EXPECT_NEAR(point.angle, angle(1e-3 * static_cast<double>(tick)), 1e-12) << tick;
    EXPECT_NEAR(point.speed, speed(1e-3 * static_cast<double>(tick)), 1e-9) << tick;
    EXPECT_EQ(point.torque, 5);
  }
  // Behind its last point it holds.
  EXPECT_EQ(follower.At(150).angle, angles.back());
  EXPECT_EQ(follower.At(150).speed, 0);
}

// Tests that a plan which comes while another waits for its delay leaves that one its turn, however fast they
// come; and that one which acts sooner takes the place of those that wait.
TEST(PlanFollower, EachOfManyPlansHasItsTurn) {
  PlanFollower follower(0.1, {.timeout_s = 0.2, .delay_s = 0.01, .largest_speed = kNone, .largest_angle = 1},
                        1000);
  const auto at = [&](int64_t tick, double angle) {
    arm_plan_t plan = Plan(1, tick, {0}, {angle}, {0});
    plan.tick = tick;
    return plan;
  };
  for (int64_t tick = 0; tick <= 500; tick += 2) {
    ASSERT_EQ(follower.Take(at(tick, 1e-3 * static_cast<double>(tick)), tick), "");
    EXPECT_DOUBLE_EQ(follower.At(tick).angle, tick < 10 ? 0.1 : 1e-3 * static_cast<double>(tick - 10))
        << tick;
    EXPECT_FALSE(follower.silent(tick));
  }
  arm_plan_t now = at(501, 0.9);
  now.tick = -1;
  ASSERT_EQ(follower.Take(now, 501), "");
  for (int64_t tick = 501; tick < 520; ++tick) EXPECT_EQ(follower.At(tick).angle, 0.9) << tick;
}

// Tests that a planner which floods makes nothing grow and is followed still.
TEST(PlanFollower, AFloodIsFollowedStill) {
  PlanFollower follower(0.1, {.timeout_s = 0.2, .delay_s = 1, .largest_speed = kNone, .largest_angle = 1},
                        1000);
  for (int64_t tick = 0; tick < 3000; ++tick) {
    arm_plan_t plan = Plan(1, tick, {0}, {1e-4 * static_cast<double>(tick)}, {0});
    plan.tick = tick;
    ASSERT_EQ(follower.Take(plan, tick), "");
    const double angle = follower.At(tick).angle;
    if (tick < 2000) continue;
    EXPECT_NEAR(angle, 1e-4 * static_cast<double>(tick - 1000), 0.002)
        << tick;  // a 64th of the second that waits
  }
}

// Tests what must not be followed though every number is finite and every point within the limits.
TEST(PlanFollower, RefusesWhatWouldGoAstray) {
  const auto why = [](const arm_plan_t& plan, int64_t tick = 100) { return Follower().Take(plan, tick); };
  EXPECT_THAT(why(Plan(1, 0, {-1e308, 1e308}, {0, 0}, {0, 0})),
              HasSubstr("point 0: all numbers must be finite, and 1e9 at most"));
  EXPECT_THAT(why(Plan(1, 0, {0, 1}, {0, 0}, {0, 1e308})), HasSubstr("point 1: all numbers"));
  arm_plan_t torque = Plan(1, 0, {0, 1}, {0, 0}, {0, 0});
  torque.torque = {1e308, -1e308};
  EXPECT_THAT(why(torque), HasSubstr("point 0: all numbers"));
  // Up with 40 rad/s and back within a second: a cubic with its maximum 4/27 of that above, a third of the
  // way.
  EXPECT_THAT(why(Plan(1, 0, {0, 1}, {0, 0}, {40, 0})),
              HasSubstr("behind point 0, by its speeds: found arm angle 5.926 rad"));
  EXPECT_THAT(why(Plan(1, 0, {0, 1, 2}, {0.9, 0, 0}, {0, 0, -7})),
              HasSubstr("behind point 1, by its speeds: found arm angle 1.037"));
  EXPECT_EQ(why(Plan(1, 0, {0, 1}, {0.9, 0.9}, {-3, 3})), "");
  for (const int64_t tick :
       {int64_t{1102}, int64_t{1'000'000'000'000}, std::numeric_limits<int64_t>::max()}) {
    arm_plan_t plan = Plan(1, 0, {0}, {0}, {0});
    plan.tick = tick;
    EXPECT_THAT(why(plan), HasSubstr("at tick 100, allowed is up to a second ahead")) << tick;
    plan.tick = 1100;
    EXPECT_EQ(why(plan), "");
  }
}

// Tests that one which was sent by mistake, for a time far ahead, keeps nobody else out.
TEST(PlanFollower, AStrayPlanDeafensNobody) {
  PlanFollower follower = Follower();
  arm_plan_t stray = Plan(2, 0, {0}, {0}, {0});
  stray.tick = int64_t{1} << 62;
  EXPECT_NE(follower.Take(stray, 10), "");
  EXPECT_EQ(follower.Take(Plan(1, 0, {0}, {0.2}, {0}), 11), "");
  EXPECT_EQ(follower.At(11).angle, 0.2);
}

// Tests that the reference never leaves the largest angle, whichever way ticks and speeds go, and that after
// a restart it begins anew.
TEST(PlanFollower, NeverLeavesTheLargestAngle) {
  PlanFollower follower = Follower(2);
  ASSERT_EQ(follower.Take(Plan(1, 0, {0}, {0.9}, {0}), 6000), "");
  for (int64_t tick = 6000; tick < 6400; tick += 5) follower.At(tick);
  for (const int64_t tick : {0, 5, 10, 3000, 20}) EXPECT_LE(std::fabs(follower.At(tick).angle), 1) << tick;
  follower.Reset();
  EXPECT_EQ(follower.At(0).angle, 0.1);
  ASSERT_EQ(follower.Take(Plan(1, 1, {0}, {-0.9}, {0}), 5), "");
  EXPECT_NEAR(follower.At(5).angle, 0.09, 1e-12) << "at 2 rad/s";
}

// Tests that a largest angle which becomes smaller holds for plans that are followed or wait, too.
TEST(PlanFollower, AnotherLargestAngleHoldsAtOnce) {
  PlanFollower follower = Follower();
  ASSERT_EQ(follower.Take(Plan(1, 0, {0, 1}, {0, 0.5}, {0, 0}), 0), "");
  EXPECT_EQ(follower.At(0).angle, 0);
  const double reached = follower.At(200).angle;
  follower.SetLargestAngle(0.3);
  EXPECT_EQ(follower.At(210).angle, reached);
  EXPECT_EQ(follower.At(900).angle, reached);
  EXPECT_THAT(follower.Take(Plan(1, 1, {0}, {0.4}, {0}), 900), HasSubstr("allowed |alpha| <= 0.3"));
}

TEST(PlanFollower, HoldsWhenThePlannerIsSilent) {
  PlanFollower follower = Follower();
  EXPECT_FALSE(follower.silent(1000)) << "there was none yet";
  ASSERT_EQ(follower.Take(Plan(1, 0, {0, 1}, {0, 1}, {1, 1}), 0), "");
  for (int64_t tick = 0; tick <= 200; tick += 5)
    EXPECT_NEAR(follower.At(tick).angle, 1e-3 * static_cast<double>(tick), 1e-12);
  EXPECT_FALSE(follower.silent(200));
  for (int64_t tick = 205; tick <= 900; tick += 5) EXPECT_NEAR(follower.At(tick).angle, 0.2, 1e-12) << tick;
  EXPECT_TRUE(follower.silent(205));
  EXPECT_EQ(follower.At(905).speed, 0);
}

TEST(PlanFollower, LimitsTheSpeed) {
  PlanFollower follower = Follower(0.5);
  EXPECT_EQ(follower.At(0).angle, 0.1);
  ASSERT_EQ(follower.Take(Plan(1, 0, {0}, {0.3}, {9}), 0), "");
  EXPECT_DOUBLE_EQ(follower.At(10).angle, 0.105);
  EXPECT_DOUBLE_EQ(follower.At(30).angle, 0.115);
}

// Tests that the newest plan counts, whatever comes behind it, and that another planner's only when the first
// is silent.
TEST(PlanFollower, FollowsOnePlannersNewest) {
  PlanFollower follower = Follower();
  ASSERT_EQ(follower.Take(Plan(1, 5, {0}, {0.2}, {0}), 0), "");
  EXPECT_EQ(follower.Take(Plan(1, 4, {0}, {0.3}, {0}), 1), "") << "overtaken";
  EXPECT_THAT(follower.Take(Plan(2, 0, {0}, {0.4}, {0}), 2),
              HasSubstr("another planner is followed already"));
  EXPECT_EQ(follower.At(5).angle, 0.2);
  EXPECT_EQ(follower.Take(Plan(2, 0, {0}, {0.4}, {0}), 300), "");
  EXPECT_EQ(follower.At(305).angle, 0.4);
}

// Tests that one number that the planner has not reached deafens the loop no longer than a silent planner
// would, and that what is repeated after that is still not followed.
TEST(PlanFollower, OneFarNumberDeafensNobody) {
  PlanFollower follower = Follower();
  ASSERT_EQ(follower.Take(Plan(1, 7, {0.1}, {0.2}, {0}), 0), "");
  ASSERT_EQ(follower.Take(Plan(1, int64_t{1} << 62, {0.2}, {0.25}, {0}), 1), "");
  EXPECT_EQ(follower.Take(Plan(1, 8, {0.3}, {0.3}, {0}), 2), "");
  EXPECT_EQ(follower.At(200).angle, 0.25) << "who it was cannot be told yet";
  EXPECT_EQ(follower.Take(Plan(1, 7, {0.1}, {0.2}, {0}), 300), "");
  EXPECT_EQ(follower.At(300).angle, 0.25) << "repeated";
  EXPECT_EQ(follower.Take(Plan(1, 9, {0.3}, {0.4}, {0}), 305), "");
  EXPECT_EQ(follower.At(305).angle, 0.4);
  EXPECT_EQ(follower.Take(Plan(1, 10, {0.4}, {0.5}, {0}), 310), "");
  EXPECT_EQ(follower.At(405).angle, 0.5);
}

TEST(PlanFollower, RefusesWithTheReason) {
  PlanFollower follower = Follower();
  EXPECT_THAT(follower.Take(Plan(1, 0, {}, {}, {}), 0), HasSubstr("found 0 points, allowed 1 to 256"));
  EXPECT_THAT(follower.Take(Plan(1, 0, {0, 0}, {0, 0}, {0, 0}), 0),
              HasSubstr("point 1: its time must be above"));
  EXPECT_THAT(follower.Take(Plan(1, 0, {NAN}, {0}, {0}), 0),
              HasSubstr("point 0: all numbers must be finite"));
  EXPECT_THAT(follower.Take(Plan(1, 0, {0}, {-1.5}, {0}), 0),
              HasSubstr("found arm angle -1.5 rad, allowed |alpha| <= 1"));
  EXPECT_EQ(follower.At(5).angle, 0.1);
}

}  // namespace
}  // namespace hydro::position_ctrl
