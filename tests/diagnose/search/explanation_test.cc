// Explanations of short runs of a rig.
#include "diagnose/search/explanation.h"

#include <gtest/gtest.h>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

struct Rig {
  std::vector<diagnose::RunData> runs = ClampedPair(Table1With(), 0.5, 1);
  diagnose::SearchContext context;

  Rig() {
    context.given = Table1With();
    context.runs = PointersTo(runs);
  }
};

// Tests that measured starts are those of the runs, in their order.
TEST(MeasuredStarts, AreThoseOfTheRuns) {
  const Rig rig;
  EXPECT_EQ(diagnose::MeasuredStarts(rig.context.runs), StartsOf(rig.runs));
}

// Tests that the true model explains all runs to the noise, with each held out in turn.
TEST(Explain, HoldsOutEachRunInTurn) {
  const Rig rig;
  const diagnose::Explanation one = diagnose::Explain(rig.context, WithFree(Table1With(), {"b", "T_s"}),
                                                      diagnose::MeasuredStarts(rig.context.runs), {});
  ASSERT_TRUE(one.fitted.ok());
  // 0.5 s of 4 signals at 1 kHz: the mean of 4000 squares is within 10 % of 1.
  EXPECT_NEAR(one.squared_gap(), 1, 0.1);
  EXPECT_NEAR(one.held_out_gap(), 1, 0.1);
  EXPECT_EQ(one.held_out.count, one.fitted.count);
}

// Tests that only the runs held out are predicted if there are any.
TEST(Explain, PredictsTheHeldOutRuns) {
  Rig rig;
  rig.context.held_out = {rig.context.runs.back()};
  rig.context.runs.pop_back();
  const diagnose::Explanation one = diagnose::Explain(rig.context, WithFree(Table1With(), {"b"}),
                                                      diagnose::MeasuredStarts(rig.context.runs), {});
  ASSERT_TRUE(one.fitted.ok());
  EXPECT_EQ(one.fitted.runs.size(), 1u);
  EXPECT_EQ(one.held_out.count, one.fitted.count);  // both runs are equally long
  EXPECT_NEAR(one.held_out_gap(), 1, 0.15);
}

// Tests that sets of changes are compared in whatever order.
TEST(SameChanges, InAnyOrder) {
  diagnose::Hypothesis one, other;
  one.changes = {{"amp.lag", {}, ""}, {"", {}, "b"}};
  other.changes = {{"", {}, "b"}, {"amp.lag", {}, ""}};
  EXPECT_TRUE(diagnose::SameChanges(one, other));
  other.changes[1].effect = "amp.delay";
  EXPECT_FALSE(diagnose::SameChanges(one, other));
}

// Tests that a resonance is not looked for beyond what the samples can show, and that a model's own frequency has no such limit.
TEST(Hypothesis, FrequenciesBelowHalfTheSamplingRate) {
  const model::ModelDescription wave =
      Table1With({{"line.wave", {{"frequency", 300}, {"volume_fraction", 0.1}, {"damping", 0.1}}, {}}});
  diagnose::Hypothesis hypothesis = WithFree(wave, {});
  const auto highest = [&] {
    for (const diagnose::FreeParameter& one : hypothesis.Free()) {
      if (one.role == model::Role::kFrequency) return one.high;
    }
    return 0.0;
  };
  EXPECT_GT(highest(), 1000);
  hypothesis.highest_frequency = 500;
  EXPECT_EQ(highest(), 500);
}

}  // namespace
}  // namespace hydro::testing
