// The verdict by the gaps that are left, on made-up ones.
#include "diagnose/say/judgement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/diagnose/say/made_up.h"

namespace hydro::testing {
namespace {

using diagnose::Verdict;

constexpr double kSample = 1e-3;  // s
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// A lag that was found; windows judged.
struct Judged {
  diagnose::Proof proof = ProofOf({Leaving(400, Freed({})), Leaving(100, Freed({}, {kLag}))});
  diagnose::Diagnosis d;

  // Gaps over 0.4 s and 1.6 s: as given, with other values, with the lag.
  Judged(diagnose::BeforeAfter near, diagnose::BeforeAfter far) {
    d.horizons = {{0.1, {}, {}, {}, {2, 2, 1}}, {0.4, {}, {}, {}, near}, {1.6, {}, {}, {}, far}};
    d.fit = d.held_out = {20, 15, 10};
    d.effects.emplace_back().id = "amp.lag";
  }

  Verdict Of(const std::vector<diagnose::ScoredSet>& scores = {}, double longest = 0) const {
    return VerdictOn(d, proof, scores, {false, kSample, longest});
  }
  // The model as given, or other values of it, is best.
  void FindNoEffect(const std::vector<std::string>& values) {
    d.effects.clear();
    proof.sets.back().hypothesis = Freed(values);
  }
};

// Tests that windows that are left at the noise name the effect whatever whole runs add up to, and that more
// is a part.
TEST(VerdictOn, WindowsDecide) {
  EXPECT_EQ(Judged({12, 6, 1.2}, {30, 12, 2}).Of(), Verdict::kNamed);
  EXPECT_EQ(Judged({12, 6, 1.9}, {30, 12, 2}).Of(), Verdict::kPartly);
  EXPECT_EQ(Judged({12, 6, 1.2}, {30, 12, 9}).Of(), Verdict::kPartly)
      << "more than errors of values add up to";
  Judged tied({12, 6, 1.2}, {30, 12, 2});
  tied.d.effects[0].tied_with = {"amp.delay"};
  EXPECT_EQ(tied.Of(), Verdict::kTied);
  Judged whole({12, 6, 1.2}, {30, 12, 2});
  whole.proof.seconds = 0;
  EXPECT_EQ(whole.Of(), Verdict::kPartly) << "where whole runs judge, they are far from the noise";
}

// Tests that a hundredth of a large gap is no part that is missing: fine sensors see the fourth digit of
// values, and no machine's equations are truer.
TEST(VerdictOn, AHundredthIsNothing) {
  EXPECT_EQ(Judged({348, 60, 1.9}, {2740, 500, 18}).Of(), Verdict::kNamed);
  EXPECT_EQ(Judged({348, 60, 4}, {2740, 500, 18}).Of(), Verdict::kPartly);
  EXPECT_EQ(Judged({348, 60, 1.9}, {2740, 500, 40}).Of(), Verdict::kPartly);
}

// Tests that gaps that are not finite reject nothing.
TEST(VerdictOn, WhatCannotBeFollowedRejectsNothing) {
  Judged one({kInfinite, std::nan(""), 1.2}, {std::nan(""), std::nan(""), std::nan("")});
  one.d.fit = one.d.held_out = {kInfinite, kInfinite, kInfinite};
  EXPECT_EQ(one.Of(), Verdict::kNamed);
  EXPECT_FALSE(diagnose::IsWorse({kInfinite, 1, kInfinite}));
  EXPECT_FALSE(diagnose::IsWorse({2, 1, kInfinite}));
  EXPECT_TRUE(diagnose::IsWorse({2, 1, 3}));
}

// Tests that a gap that is left beside an effect of which the balances say nothing is unexplained, unless
// they cannot see it or say what it is tied with.
TEST(VerdictOn, AGapBesideASingleWitness) {
  Judged one({12, 6, 3}, {30, 12, 9});
  one.d.explanations = {{{"amp.lag"}, 0.05}, {{"amp.delay"}, 0.95}};
  EXPECT_EQ(one.Of(), Verdict::kPartly);
  one.d.explanations = {{{"amp.delay"}, 1}};
  EXPECT_EQ(one.Of(), Verdict::kUnexplained);
  EXPECT_EQ(one.Of({{{"amp.delay"}, 60}, {{"amp.lag"}, 58}}), Verdict::kPartly)
      << "balances hardly tell them apart";
  EXPECT_EQ(one.Of({{{"amp.delay"}, 60}, {{"amp.lag"}, 40}}), Verdict::kUnexplained);
  EXPECT_EQ(one.Of({{{"amp.delay"}, 19}, {{"amp.delay", "amp.lag"}, 17}, {{}, 0}, {{"amp.lag"}, -2}}),
            Verdict::kUnexplained)
      << "it only lowers what another has";
  one.d.effects[0].tied_with = {"amp.delay"};
  EXPECT_EQ(one.Of(), Verdict::kPartly);
  one.d.effects[0].tied_with.clear();
  one.d.effects[0].id = "valve.relief";
  EXPECT_EQ(one.Of(), Verdict::kPartly);
  one.d.effects[0].id = "amp.lag";
  one.d.horizons[1].typical.after = 1.2;
  one.d.horizons[2].typical.after = 2;
  EXPECT_EQ(one.Of(), Verdict::kNamed) << "no gap is left";
}

// Tests that an effect that by its interval may as well be absent is not named, though held-out windows like
// it.
TEST(VerdictOn, WhatMayBeAbsentIsNotNamed) {
  Judged one({12, 6, 1.2}, {30, 12, 2});
  one.d.effects[0].id = "fluid.warming";
  one.d.effects[0].parameters = {{"rate", 5e-4, -1e-3, 2e-3, "1/s"}};
  one.d.explanations = {{{"fluid.warming"}, 1}};
  EXPECT_EQ(one.Of(), Verdict::kUnexplained);
  one.d.effects[0].tied_with = {"amp.lag"};
  EXPECT_EQ(one.Of(), Verdict::kTied);
  one.d.effects[0].tied_with.clear();
  one.d.effects[0].parameters[0].low = 1e-4;
  EXPECT_EQ(one.Of(), Verdict::kNamed);
}

// Tests that a lag of a sample or two that simulation alone speaks for is not named where it closes the gap,
// and that a longer one is, and one of which balances speak.
TEST(VerdictOn, WhatARecorderDoesToo) {
  Judged one({12, 6, 1.2}, {30, 12, 2});
  one.d.effects[0].parameters = {{"tau", 1.1 * kSample, 0, 0, "s"}};
  one.d.explanations = {{{}, 1}};
  EXPECT_EQ(one.Of(), Verdict::kUnexplained);
  one.d.explanations = {{{"amp.lag"}, 0.1}, {{}, 0.9}};
  EXPECT_EQ(one.Of(), Verdict::kNamed);
  one.d.explanations = {{{}, 1}};
  one.d.effects[0].parameters[0].value = 2.5 * kSample;
  EXPECT_EQ(one.Of(), Verdict::kNamed);
}

// Tests values alone: parameters at the noise, a part above it, and nothing missing where the model as given
// is at the noise too and none of them is surely another.
TEST(VerdictOn, ValuesAlone) {
  Judged one({12, 1.2, 1.2}, {30, 2, 2});
  one.FindNoEffect({"b", "T_s", "J", "beta"});
  EXPECT_EQ(one.Of(), Verdict::kParameters);
  one.d.horizons[1].typical = {12, 3, 3};
  EXPECT_EQ(one.Of(), Verdict::kPartly);
  one.d.horizons[1].typical = {1.2, 1.1, 1.1};
  EXPECT_EQ(one.Of(), Verdict::kNothingMissing);
}

// Tests that a value that is the given one in every digit that is shown is no finding, where whole runs judge
// too; and that nothing is missing then, although the model as given leaves a little more.
TEST(VerdictOn, AValueThatLooksTheSame) {
  Judged one({1.3, 1.05, 1.05}, {1.3, 1.05, 1.05});
  one.FindNoEffect({"J"});
  one.proof.seconds = 0;
  one.d.fit = one.d.held_out = {1.26, 1.05, 1.05};
  one.d.parameters.emplace_back().model = 0.03;
  one.d.parameters[0].fitted.value = 0.0300001;
  EXPECT_EQ(one.Of(), Verdict::kNothingMissing);
  one.d.parameters[0].fitted.value = 0.031;
  EXPECT_EQ(one.Of(), Verdict::kParameters);
  one.FindNoEffect({});
  one.d.parameters.clear();
  one.d.fit = one.d.held_out = {1.26, 1.26, 1.26};
  EXPECT_EQ(one.Of(), Verdict::kUnexplained);
  one.proof.given_suffices = true;
  EXPECT_EQ(one.Of(), Verdict::kNothingMissing);
}

// Tests that nothing is missing only where whole runs say so too, as far as the model can follow them, and
// that over long runs small errors may add up.
TEST(VerdictOn, NothingMissingOverWholeRunsToo) {
  Judged one({1.05, 1.05, 1.05}, {1.1, 1.1, 1.1});
  one.FindNoEffect({});
  one.d.fit = one.d.held_out = {1.05, 1.05, 1.05};
  EXPECT_EQ(one.Of(), Verdict::kNothingMissing);
  one.d.fit = one.d.held_out = {3, 3, 3};
  EXPECT_EQ(one.Of(), Verdict::kUnexplained);
  EXPECT_EQ(one.Of({}, 4), Verdict::kNothingMissing);
  one.d.fit = one.d.held_out = {12, 12, 12};
  EXPECT_EQ(one.Of({}, 4), Verdict::kUnexplained) << "more than ten times what is left over 0.4 s";
  one.d.held_out.after = kInfinite;
  EXPECT_EQ(one.Of(), Verdict::kNothingMissing);
}

// Tests that what is left is nothing where it is the noise that the samples show, and no more than that,
// though the stated noise is a third of it.
TEST(VerdictOn, NoiseThatTheSamplesShow) {
  Judged one({2.9, 2.9, 2.9}, {2.9, 2.9, 2.9});
  one.FindNoEffect({});
  one.d.fit = one.d.held_out = {2.9, 2.9, 2.9};
  EXPECT_EQ(one.Of(), Verdict::kUnexplained);
  one.d.noise_shown = 2.85;
  EXPECT_EQ(one.Of(), Verdict::kNothingMissing);
  one.d.fit = one.d.held_out = {3.4, 3.4, 3.4};
  EXPECT_EQ(one.Of(), Verdict::kUnexplained);
}

// Tests that a curve is a part of the gap and no cause: beside an effect a part is found, alone nothing is
// explained.
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
  const diagnose::ComparedGap gap = GapToCompare(one.d, one.proof);
  EXPECT_EQ(gap.seconds, 1.6);
  EXPECT_EQ(gap.gap.after, 5);
  one.proof.seconds = 0;
  EXPECT_EQ(GapToCompare(one.d, one.proof).seconds, 0);
  EXPECT_EQ(GapToCompare(one.d, one.proof).gap.after, 10);
}

// Tests that an open verdict states a gap that is open: over longer predictions, over whole runs, of the
// fitted runs; and says where a curve has closed it.
TEST(GapToCompare, OfAnOpenVerdictIsOpen) {
  Judged one({1.05, 1.0, 0.9}, {30, 12, 9});
  one.d.verdict = Verdict::kUnexplained;
  diagnose::ComparedGap gap = GapToCompare(one.d, one.proof);
  EXPECT_EQ(gap.seconds, 1.6);
  EXPECT_EQ(gap.gap.after, 9);
  one.d.horizons[2].typical = {1.1, 1.1, 0.95};
  gap = GapToCompare(one.d, one.proof);
  EXPECT_EQ(gap.seconds, 0);
  EXPECT_EQ(gap.gap.after, 10);
  EXPECT_FALSE(gap.closed || gap.of_fitted);
  one.d.held_out = {1.1, 1.1, 1.1};
  one.d.fit = {7, 7, 6};
  gap = GapToCompare(one.d, one.proof);
  EXPECT_TRUE(gap.of_fitted);
  EXPECT_EQ(gap.gap.after, 6);
  one.d.closures.emplace_back();
  gap = GapToCompare(one.d, one.proof);
  EXPECT_TRUE(gap.closed);
  EXPECT_EQ(gap.seconds, 0.4);
}

// Tests that a gap counts as closed near the noise, and by its share only where there is hardly any noise.
TEST(VerdictOn, NearTheNoiseOrOfExactSensors) {
  Judged one({50, 50, 2}, {50, 50, 2});
  EXPECT_EQ(VerdictOn(one.d, one.proof, {}, {false, kSample}), Verdict::kPartly);
  EXPECT_EQ(VerdictOn(one.d, one.proof, {}, {true, kSample}), Verdict::kNamed);
  const std::vector<diagnose::RunData> noisy = ClampedPair(Table1With(), 0.3, 1);
  EXPECT_FALSE(diagnose::ExactSensors(PointersTo(noisy)));
  NoisyRig exact;
  exact.model = Table1With();
  exact.pressure_noise = exact.speed_noise = 0;
  exact.encoder_bits = 26;
  std::vector<diagnose::RunData> runs;
  runs.push_back(
      exact.Record("exact", model::Shaft::kClamped, 0, 0.5, false, [](double t) { return Levels(t, 0); }));
  EXPECT_TRUE(diagnose::ExactSensors(PointersTo(runs)));
  exact.encoder_bits = 14;  // steps that show
  runs.push_back(
      exact.Record("steps", model::Shaft::kClamped, 0, 0.5, false, [](double t) { return Levels(t, 0); }));
  EXPECT_FALSE(diagnose::ExactSensors(PointersTo(runs)));
}

}  // namespace
}  // namespace hydro::testing
