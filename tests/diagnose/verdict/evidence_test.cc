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

class WeightsOfTest : public ::testing::Test {
 protected:
  // A lag that leaves this squared gap on whole runs, and a relief valve that was only tried on windows, where it
  // is behind in most of them.
  std::map<std::string, double> WithAnotherOnWindows(double gap_of_lag) {
    std::vector<diagnose::RunData> runs;
    runs.push_back(SmallRun(Table1With(), model::Shaft::kClamped, true, 0.2, 0, 1));
    diagnose::SearchContext context;
    context.runs = PointersTo(runs);
    diagnose::WindowTrials windows;
    for (int i = 0; i < 10; ++i) windows.runs.push_back("run " + std::to_string(i));
    windows.tried = {Leaving(1.1, Freed({}, {kLag}), true), Scattered(1.4, 2, Freed({}, {kRelief}))};
    // The gap is that of the blocks.
    for (size_t w = 0; w < 10; ++w)
      windows.tried[1].held_out.gaps[w] = std::exp(windows.tried[1].blocks.sums[w]);
    diagnose::SearchResult search;
    search.given = Leaving(100, Freed({}), false);
    search.tried = {Leaving(gap_of_lag, Freed({}, {kLag}), false)};
    search.best = search.tried[0];
    return diagnose::WeightsOf(context, search, search.given, windows);
  }

  // A lag and a delay on windows and on whole runs, where the lag fits better on windows and the delay on runs.
  std::map<std::string, double> With(double gap_of_windows) {
    std::vector<diagnose::RunData> runs;
    runs.push_back(SmallRun(Table1With(), model::Shaft::kClamped, true, 0.2, 0, 1));
    diagnose::SearchContext context;
    context.runs = PointersTo(runs);
    diagnose::WindowTrials windows;
    windows.runs.assign(10, "square");
    windows.tried = {Leaving(50 * gap_of_windows, Freed({}), true),
                     Leaving(gap_of_windows, Freed({}, {kLag}), true),
                     Leaving(1.5 * gap_of_windows, Freed({}, {kDelay}), true)};
    diagnose::SearchResult search;
    search.given = Leaving(100, Freed({}), false);
    search.tried = {Leaving(4, Freed({}, {kLag}), false), Leaving(1.1, Freed({}, {kDelay}), false)};
    search.best = search.tried[1];
    return diagnose::WeightsOf(context, search, search.given, windows);
  }
};

// Tests that whole runs decide where windows come near the noise, and windows where they do not.
TEST_F(WeightsOfTest, WholeRunsDecideNearTheNoise) {
  EXPECT_GT(With(1.1).at("amp.delay"), 0.99);
  EXPECT_GT(With(30).at("amp.lag"), 0.99);
}

// Tests that what is behind on windows, and was therefore not tried on whole runs, takes no weight from what
// explains whole runs to the noise, but does where they are not explained.
TEST_F(WeightsOfTest, WhatIsBehindOnWindowsHasNoPartOnceTheNoiseIsReached) {
  EXPECT_NEAR(WithAnotherOnWindows(1.1).at("amp.lag"), 1, 1e-9);
  EXPECT_LT(WithAnotherOnWindows(1.6).at("amp.lag"), 0.99);
  EXPECT_GT(WithAnotherOnWindows(1.6).at("valve.relief"), 0.01);
}

}  // namespace
}  // namespace hydro::testing
