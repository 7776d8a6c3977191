// What explanations claim, and the evidence for each.
#include "diagnose/verdict/evidence.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/diagnose/verdict/made_up.h"

namespace hydro::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

// Tests each kind of claim: effects in order, whatever values are fitted beside them; few values by name; more
// as "parameters"; none.
TEST(ClaimOf, EachKind) {
  EXPECT_EQ(diagnose::ClaimOf(Freed({})), "as given");
  EXPECT_EQ(diagnose::ClaimOf(Freed({"b"}, {{"", {}, "b"}})), "parameter b");
  EXPECT_EQ(diagnose::ClaimOf(Freed({"b"})), "parameter b") << "the refit of the only value that is free";
  EXPECT_EQ(diagnose::ClaimOf(Freed({"b", "T_s", "J", "beta"})), "parameters");
  EXPECT_EQ(diagnose::ClaimOf(Freed({}, {kLag})), "amp.lag");
  EXPECT_EQ(diagnose::ClaimOf(Freed({"b", "T_s", "J", "beta"}, {kLag})), "amp.lag");
  EXPECT_EQ(diagnose::ClaimOf(Freed({}, {{"sensor.skew", {{"signal", "p1"}}, ""}, kLag})),
            "amp.lag + sensor.skew (p1)");
}

// Tests that evidence is in squared gaps, of windows and of whole runs, and that only what was predicted has any.
TEST(ContestOf, SquaredGapsOfBlocks) {
  const diagnose::Explanation near = Leaving(4, Freed({}, {kLag}), true);
  const diagnose::Explanation whole = Leaving(9, Freed({"b"}, {kLag}), false);
  diagnose::Explanation fitted_only = near;
  fitted_only.blocks.sums.clear();
  const std::vector<std::string> runs(10, "square");
  const diagnose::Contest on_windows = diagnose::ContestOf({&near, &fitted_only}, runs);
  ASSERT_EQ(on_windows.evidence.size(), 1u);
  EXPECT_TRUE(on_windows.geometric);
  EXPECT_NEAR(on_windows.evidence[0].squared_gaps[3], 4, 1e-9);
  EXPECT_THAT(on_windows.evidence[0].parts, ElementsAre("amp.lag"));
  const diagnose::Contest on_runs = diagnose::ContestOf({&whole}, runs);
  EXPECT_FALSE(on_runs.geometric);
  EXPECT_NEAR(on_runs.evidence[0].squared_gaps[3], 9, 1e-9);
  EXPECT_THAT(on_runs.evidence[0].parts, UnorderedElementsAre("amp.lag", "b"));
}

// A lag found on windows, where a delay leaves more; over whole runs the delay leaves less.
diagnose::WideSearch FoundLag() {
  diagnose::WideSearch found;
  found.windows.decide = true;
  found.windows.runs.assign(10, "square");
  found.windows.tried = {Leaving(1500, Freed({}), true), Leaving(30, Freed({}, {kLag}), true),
                         Leaving(45, Freed({}, {kDelay}), true)};
  found.search.given = found.refit = Leaving(100, Freed({}), false);
  found.search.best = Leaving(4, Freed({}, {kLag}), false);
  found.search.tried = {found.search.best, Leaving(1.1, Freed({}, {kDelay}), false)};
  return found;
}

// Tests the claims of sets as the balances name them: effects with their names, values by themselves only.
TEST(ClaimOfSet, SetsOfTheBalances) {
  EXPECT_EQ(diagnose::ClaimOfSet({}), "as given");
  EXPECT_EQ(diagnose::ClaimOfSet({"sensor.skew(p1)", "amp.lag", "value.b"}), "amp.lag + sensor.skew (p1)");
  EXPECT_EQ(diagnose::ClaimOfSet({"value.b"}), "parameter b");
  EXPECT_EQ(diagnose::ClaimOfSet({"run.T_s"}), "run.T_s");
}

// Tests that the balances' explanations say how probable what was found is, the same claims together.
TEST(WeightsOf, AsTheBalancesSay) {
  const diagnose::SearchContext context;
  const std::map<std::string, double> weights = diagnose::WeightsOf(
      context, FoundLag(), {{{"amp.lag"}, 0.5}, {{"amp.lag", "value.b"}, 0.2}, {{"amp.delay"}, 0.3}});
  EXPECT_NEAR(weights.at("amp.lag"), 0.7, 1e-12);
  EXPECT_NEAR(weights.at("amp.delay"), 0.3, 1e-12);
}

// Tests that the windows that decided say it where no explanation of the balances claims what was found.
TEST(WeightsOf, AsWindowsSayOfWhatBalancesCannotSee) {
  const diagnose::SearchContext context;
  for (const std::vector<diagnose::WeightedSet>& explanations :
       {std::vector<diagnose::WeightedSet>{}, {{{"amp.delay"}, 1.0}}}) {
    EXPECT_GT(diagnose::WeightsOf(context, FoundLag(), explanations).at("amp.lag"), 0.99);
  }
}

}  // namespace
}  // namespace hydro::testing
