// The verdict by the gaps that are left, on made-up ones.
#include "diagnose/verdict/judgement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/diagnose/verdict/made_up.h"

namespace hydro::testing {
namespace {

using diagnose::Verdict;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// A lag that was found; windows decide.
struct Judged {
  diagnose::SearchContext context;
  diagnose::Kept kept;
  diagnose::WindowTrials windows;
  diagnose::Diagnosis d;

  // Gaps over 0.4 s and 1.6 s: as given, with other values, with the lag.
  Judged(diagnose::BeforeAfter near, diagnose::BeforeAfter far) {
    kept.search.given = Leaving(400, Freed({}), false);
    kept.search.best = Leaving(100, Freed({}, {kLag}), false);
    windows.decide = true;
    d.horizons = {{0.1, {}, {}, {}, {2, 2, 1}}, {0.4, {}, {}, {}, near}, {1.6, {}, {}, {}, far}};
    d.held_out = {20, 15, 10};
    d.effects.emplace_back().id = "amp.lag";
  }

  Verdict Of() const { return VerdictOn(context, kept, windows, d); }
};

// Tests that windows that are left at the noise name the effect whatever whole runs add up to, and that more is a part.
TEST(VerdictOn, WindowsDecide) {
  EXPECT_EQ(Judged({12, 6, 1.2}, {30, 12, 2}).Of(), Verdict::kNamed);
  EXPECT_EQ(Judged({12, 6, 1.9}, {30, 12, 2}).Of(), Verdict::kPartly);
  EXPECT_EQ(Judged({12, 6, 1.2}, {30, 12, 9}).Of(), Verdict::kPartly)
      << "more than errors of values add up to";
  Judged tied({12, 6, 1.2}, {30, 12, 2});
  tied.d.effects[0].tied_with = {"amp.delay"};
  EXPECT_EQ(tied.Of(), Verdict::kTied);
  Judged whole({12, 6, 1.2}, {30, 12, 2});
  whole.windows.decide = false;
  EXPECT_EQ(whole.Of(), Verdict::kPartly) << "where whole runs decide, they are far from the noise";
}

// Tests that gaps that are not finite reject nothing.
TEST(VerdictOn, WhatCannotBeFollowedRejectsNothing) {
  Judged one({kInfinite, std::nan(""), 1.2}, {std::nan(""), std::nan(""), std::nan("")});
  one.kept.search.given.held_out.sum = kInfinite;
  one.kept.search.best.held_out.sum = kInfinite;
  EXPECT_EQ(one.Of(), Verdict::kNamed);
  one.kept.doubts = {"no rig is likely to have it"};
  EXPECT_EQ(one.Of(), Verdict::kPartly) << "following the runs is material";
  EXPECT_FALSE(diagnose::IsWorse({kInfinite, 1, kInfinite}));
  EXPECT_FALSE(diagnose::IsWorse({2, 1, kInfinite}));
  EXPECT_TRUE(diagnose::IsWorse({2, 1, 3}));
}

// Tests that a doubt speaks against an effect unless it takes half of the squared gap that other values leave.
TEST(VerdictOn, ADoubtNeedsAMaterialPart) {
  Judged one({12, 6, 3}, {30, 12, 9});
  one.kept.doubts = {"no rig is likely to have it"};
  EXPECT_EQ(one.Of(), Verdict::kPartly);
  one.d.horizons[1].typical.after = 5;
  EXPECT_EQ(one.Of(), Verdict::kUnexplained);
}

// Tests values alone: parameters at the noise, a part above it, and nothing missing where the model as given is at the noise too and
// none of them is surely another.
TEST(VerdictOn, ValuesAlone) {
  Judged one({12, 1.2, 1.2}, {30, 2, 2});
  one.d.effects.clear();
  one.kept.search.best = Leaving(100, Freed({"b", "T_s", "J", "beta"}), false);
  EXPECT_EQ(one.Of(), Verdict::kParameters);
  one.d.horizons[1].typical = {12, 3, 3};
  EXPECT_EQ(one.Of(), Verdict::kPartly);
  one.d.horizons[1].typical = {1.2, 1.1, 1.1};
  EXPECT_EQ(one.Of(), Verdict::kNothingMissing);
}

// Tests that nothing is missing only where whole runs say so too, as far as the model can follow them.
TEST(VerdictOn, NothingMissingOverWholeRunsToo) {
  Judged one({1.05, 1.05, 1.05}, {1.1, 1.1, 1.1});
  one.d.effects.clear();
  one.kept.search.best = one.kept.search.given = Leaving(1.1, Freed({}), false);
  EXPECT_EQ(one.Of(), Verdict::kNothingMissing);
  one.kept.search.best = one.kept.search.given = Leaving(9, Freed({}), false);
  EXPECT_EQ(one.Of(), Verdict::kUnexplained);
  one.kept.search.best.held_out.sum = kInfinite;
  EXPECT_EQ(one.Of(), Verdict::kNothingMissing);
}

// Tests that a curve is a part of the gap and no cause: beside an effect a part is found, alone nothing is explained.
TEST(VerdictOn, AClosureIsAPart) {
  Judged one({12, 6, 1.1}, {30, 12, 1.5});
  one.d.closures.emplace_back().id = "closure.pump_torque";
  EXPECT_EQ(one.Of(), Verdict::kPartly);
  one.d.effects.clear();
  EXPECT_EQ(one.Of(), Verdict::kUnexplained);
}

// Tests that the gap that is compared is of the horizon next to 0.4 s that has one.
TEST(GapToCompare, OfTheNearestHorizon) {
  Judged one({12, 6, std::nan("")}, {30, 12, 5});
  one.d.horizons.erase(one.d.horizons.begin());
  const diagnose::ComparedGap gap = GapToCompare(one.d, one.windows);
  EXPECT_EQ(gap.seconds, 1.6);
  EXPECT_EQ(gap.gap.after, 5);
  one.windows.decide = false;
  EXPECT_EQ(GapToCompare(one.d, one.windows).seconds, 0);
  EXPECT_EQ(GapToCompare(one.d, one.windows).gap.after, 10);
}

}  // namespace
}  // namespace hydro::testing
