#include "tune/search/goals.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "tests/settings/texts.h"

namespace hydro::tune {
namespace {

using settings::InputErrorOf;
using ::testing::HasSubstr;

TEST(Goals, AreRead) {
  const Goals goals = ParseGoals({"bandwidth_hz=3.5", "overshoot_percent=0", "settling_s=0.4", "step=.1"});
  EXPECT_EQ(goals.bandwidth_hz, 3.5);
  EXPECT_EQ(goals.overshoot_percent, 0);
  EXPECT_EQ(goals.settling_s, 0.4);
  EXPECT_EQ(goals.step, 0.1);
  EXPECT_TRUE(goals.any());
  EXPECT_FALSE(ParseGoals({}).any());
  EXPECT_FALSE(ParseGoals({"step=0.2"}).any()) << "a step is what goals are about, not one of them";
}

// Tests that a step is in the unit of the arm, or brought to it, and its former name is read where it is
// true.
TEST(Goals, AStepHasAUnit) {
  EXPECT_DOUBLE_EQ(*ParseGoals({"step=5 deg"}).step, 5 * kDegree);
  EXPECT_DOUBLE_EQ(*ParseGoals({"step=30 mm"}, "m").step, 0.03);
  EXPECT_DOUBLE_EQ(*ParseGoals({"step=30mm"}, "m").step, 0.03);
  EXPECT_THAT(InputErrorOf([] { ParseGoals({"step=30mm"}); }),
              HasSubstr("--goal: step: found \"30mm\", allowed a number (in rad), or a text"));
  EXPECT_EQ(ParseGoals({"step=0.03"}, "m").step, 0.03);
  EXPECT_EQ(ParseGoals({"step_rad=0.2"}).step, 0.2);
  EXPECT_THAT(InputErrorOf([] { ParseGoals({"step_rad=0.2"}, "m"); }), HasSubstr("allowed NAME=VALUE"));
  EXPECT_THAT(InputErrorOf([] { ParseGoals({"step=5 deg"}, "m"); }),
              HasSubstr("--goal: step: found \"5 deg\", allowed a number (in m)"));
}

TEST(Goals, ThatAreWrongAreNamed) {
  const auto error = [](const std::vector<std::string>& texts) {
    return InputErrorOf([&] { ParseGoals(texts); });
  };
  EXPECT_THAT(error({"speed=3"}),
              HasSubstr("--goal: found \"speed=3\", allowed NAME=VALUE with NAME \"bandwidth_hz\""));
  EXPECT_THAT(error({"settling_s"}), HasSubstr("allowed settling_s= a finite number above 0"));
  EXPECT_THAT(error({"settling_s=0"}), HasSubstr("found \"settling_s=0\""));
  EXPECT_THAT(error({"overshoot_percent=-1"}), HasSubstr("from 0 on"));
  EXPECT_THAT(error({"step=inf"}), HasSubstr("finite"));
  EXPECT_THAT(error({"step_rad=0.1", "step=0.2"}), HasSubstr("step twice"));
}

}  // namespace
}  // namespace hydro::tune
