#include "tune/search/search.h"

#include <gtest/gtest.h>

#include "tests/tune/search/configs.h"
#include "tune/search/report.h"

namespace hydro::tune {
namespace {

const auto kSilent = [](double) {};

// Tests that a search keeps its margins, does not depend on the number of threads, and betters what it starts
// from.
TEST(SearchGains, IsTheSameOnAnyNumberOfThreads) {
  const Goals goals = {.step = 0.1};
  const StepJudge judge(Retuned(), {.goals = goals, .samples = 0});
  const Gains pressure = ChoosePressureLoop(judge.config());
  const SearchResult one = SearchGains(judge, goals, pressure, false, 1, kSilent);
  const SearchResult three = SearchGains(judge, goals, pressure, false, 3, kSilent);
  ASSERT_TRUE(one.found);
  EXPECT_EQ(one.best.gains.c1, three.best.gains.c1);
  EXPECT_EQ(one.best.gains.c2, three.best.gains.c2);
  EXPECT_EQ(one.tried.size(), three.tried.size());
  EXPECT_LT(one.best.steps.ratio, TryGains(judge, GainsOf(judge.config())).steps.ratio);
  for (const Tried& tried : one.tried) {
    EXPECT_GE(tried.check.position->worst.gain, kLeastGainMargin);
    EXPECT_GE(tried.check.position->worst.phase_deg, kLeastPhaseMargin);
  }
  const std::vector<TradeOff> rows = TradeOffs(one.tried);
  ASSERT_FALSE(rows.empty());
  for (const TradeOff& row : rows) EXPECT_GE(row.tried.check.position->worst.gain, row.gain_margin * 0.998);
}

// Tests that a goal is met with a wider margin than the fastest gains have.
TEST(SearchGains, MeetsGoalsWithTheWidestMargins) {
  const Goals goals = {.settling_s = 0.5, .step = 0.1};
  const StepJudge judge(Retuned(), {.goals = goals, .samples = 0});
  const Gains pressure = ChoosePressureLoop(judge.config());
  const SearchResult calm = SearchGains(judge, goals, pressure, false, 2, kSilent);
  const SearchResult fast = SearchGains(judge, {.step = 0.1}, pressure, false, 2, kSilent);
  EXPECT_EQ(Misses(goals, calm.best), 0);
  EXPECT_LE(calm.best.steps.settling, 0.5);
  EXPECT_GT(calm.best.check.position->worst.gain, fast.best.check.position->worst.gain);
  EXPECT_GT(calm.best.steps.ratio, fast.best.steps.ratio);
}

TEST(ChoosePressureLoop, TakesASlowerOneWhereTheDelaysNeedIt) {
  EXPECT_EQ(ChoosePressureLoop(Retuned()).natural_frequency, 150);
  const Gains slow = ChoosePressureLoop(Retuned({"plant.rate_hz=1000", "limits.arm_angle=0.6"}));
  EXPECT_LT(slow.natural_frequency, 150);
  EXPECT_THROW(ChoosePressureLoop(
                   Retuned({"plant.rate_hz=100", "time.duration_s=1", "position.sample_interval_s=0.01"})),
               std::runtime_error);
}

}  // namespace
}  // namespace hydro::tune
