// What is lost without an effect.
#include "diagnose/verdict/without_effect.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "tests/diagnose/verdict/made_up.h"
#include "tests/diagnose/verdict/small_search.h"

namespace hydro::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const diagnose::Change kDrag{"pump.quadratic_drag", {}, ""};

std::vector<std::string> AmountsOf(const std::string& id) {
  return diagnose::Amounts(*model::FindEffect(id));
}

// Tests which numbers say how much there is of an effect: not its speeds, pressures, periods and phases, nor
// those of effects that never vanish.
TEST(Amounts, AreNoneWhereTheEffectIsNone) {
  EXPECT_THAT(AmountsOf("pump.stribeck"), ElementsAre("static_excess"));
  EXPECT_THAT(AmountsOf("pump.friction_asymmetry"), ElementsAre("coulomb", "viscous"));
  EXPECT_THAT(AmountsOf("valve.relief"), ElementsAre("conductance"));
  EXPECT_THAT(AmountsOf("motor.cogging"), ElementsAre("amplitude"));
  EXPECT_THAT(AmountsOf("amp.lag"), ElementsAre("tau"));
  EXPECT_THAT(AmountsOf("arm.flexure"), IsEmpty());
}

// Tests that there may be none of an effect if all of its amounts reach to none.
TEST(MayBeNone, AllAmountsReachToNone) {
  diagnose::Hypothesis hypothesis =
      WithFree(Table1With({{"pump.friction_asymmetry", {{"coulomb", 1}, {"viscous", 0.01}}, {}}}), {});
  const diagnose::Change asymmetry{"pump.friction_asymmetry", {}, ""};
  EXPECT_FALSE(diagnose::MayBeNone(hypothesis, asymmetry, {{0.5, 1.5}, {-0.01, 0.03}}));
  EXPECT_TRUE(diagnose::MayBeNone(hypothesis, asymmetry, {{-0.5, 2.5}, {-0.01, 0.03}}));
  // A time constant is positive: a tenth of it is as good as none.
  hypothesis = WithFree(Table1With({{"amp.lag", {{"tau", 0.01}}, {}}}), {});
  EXPECT_FALSE(diagnose::MayBeNone(hypothesis, kLag, {{0.005, 0.02}}));
  EXPECT_TRUE(diagnose::MayBeNone(hypothesis, kLag, {{0.0005, 0.2}}));
}

// Tests that the profile shows what is there, with an end of the interval near the value, and not what is absent.
TEST(ProfileAtNone, ShowsWhatIsThere) {
  SmallSearch& small = OfADrag();
  const diagnose::Profile there =
      diagnose::ProfileAtNone(small.context.runs, small.search.best.fitted, small.search.given.fitted, kDrag);
  EXPECT_TRUE(there.shows);
  EXPECT_GT(there.lowest, 0.8);
  EXPECT_LT(there.lowest, 1);

  SmallSearch none(Table1With());
  const diagnose::Hypothesis with =
      diagnose::With(none.search.given.fitted.hypothesis, kDrag, none.context.sizes, false).front();
  const diagnose::Explanation needless =
      diagnose::Explain(none.context, with, diagnose::MeasuredStarts(none.context.runs), {});
  const diagnose::Profile absent =
      diagnose::ProfileAtNone(none.context.runs, needless.fitted, none.search.given.fitted, kDrag);
  EXPECT_FALSE(absent.shows);
  EXPECT_EQ(absent.lowest, 0);
}

// Tests that without the only effect nearly all of the gap comes back, and that what was tried is not fitted again.
TEST(ShareOf, TheOnlyEffectHasAll) {
  SmallSearch& small = OfADrag();
  EXPECT_GT(diagnose::ShareOf(small.context, small.search, {}, kDrag), 0.95);
  EXPECT_LE(diagnose::ShareOf(small.context, small.search, {}, kDrag), 1);
}

// Tests shares on windows: of what was tried without the effect, as a part of the gap that the model's own values leave.
TEST(ShareOf, PartsOnWindows) {
  diagnose::SearchContext context;
  context.given = Table1With();
  diagnose::SearchResult search;
  search.best = Leaving(1, Freed({}, {kLag, kRelief}), false);
  diagnose::WindowTrials windows;
  windows.decide = true;
  windows.tried = {Leaving(1000, Freed({}), true), Leaving(101, Freed({"b"}), true),
                   Leaving(1, Freed({}, {kLag, kRelief}), true), Leaving(81, Freed({}, {kRelief}), true),
                   Leaving(11, Freed({}, {kLag}), true)};
  EXPECT_NEAR(diagnose::ShareOf(context, search, windows, kLag), 0.8, 1e-12);
  EXPECT_NEAR(diagnose::ShareOf(context, search, windows, kRelief), 0.1, 1e-12);
  // Without it, values may take its part.
  windows.tried.push_back(Leaving(6, Freed({"b"}, {kLag}), true));
  EXPECT_NEAR(diagnose::ShareOf(context, search, windows, kRelief), 0.05, 1e-12);
}

// Tests that without a gap there is nothing to share, and none with a model that cannot follow the runs.
TEST(ShareOf, NothingWithoutAGap) {
  diagnose::SearchContext context;
  context.given = Table1With();
  diagnose::SearchResult search;
  search.best = Leaving(0.9, Freed({}, {kLag}), false);
  diagnose::WindowTrials windows;
  windows.decide = true;
  windows.tried = {Leaving(0.98, Freed({}), true), Leaving(0.9, Freed({}, {kLag}), true)};
  EXPECT_TRUE(std::isnan(diagnose::ShareOf(context, search, windows, kLag)));
}

// Tests the typical gap without some of the effects, as it was tried.
TEST(TypicalWithout, AsTried) {
  const diagnose::Explanation best = Leaving(1, Freed({}, {kLag, kRelief}), false);
  diagnose::WindowTrials windows;
  windows.tried = {Leaving(25, Freed({}, {kLag}), true), Leaving(4, Freed({"b"}, {kRelief, kLag}), true)};
  EXPECT_NEAR(diagnose::TypicalWithout(windows, best, {kRelief}), 5, 1e-12);
  EXPECT_NEAR(diagnose::TypicalWithout(windows, best, {}), 2, 1e-12);
  EXPECT_EQ(diagnose::TypicalWithout(windows, best, {kLag}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace hydro::testing
