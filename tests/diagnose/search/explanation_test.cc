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

// Tests that nothing is left to search for where held-out runs are predicted well, or where what was added fits runs that are held
// out in turn: a run that alone shows an effect is not predicted by the others.
TEST(LeavesNothing, HeldOutOrInTheFit) {
  diagnose::SearchContext context;
  const diagnose::RunData run;
  diagnose::Explanation one;
  one.fitted.sum = 1.1;
  one.fitted.count = 1;
  one.held_out.sum = 1.6;
  one.held_out.count = 1;
  EXPECT_FALSE(LeavesNothing(context, one, 1.25)) << "nothing was added";
  one.fitted.hypothesis.changes = {{"valve.relief", {}, ""}};
  EXPECT_TRUE(LeavesNothing(context, one, 1.25));
  context.held_out = {&run};
  EXPECT_FALSE(LeavesNothing(context, one, 1.25)) << "these runs were not fitted";
  one.held_out.sum = 1.2;
  EXPECT_TRUE(LeavesNothing(context, one, 1.25));
}

// Tests that a fit that leaves no gap is not repeated, and that one from a wrong start is mended.
TEST(RefitFromOtherStarts, MendsAWrongStart) {
  const Rig rig;
  const diagnose::Hypothesis hypothesis = WithFree(Table1With(), {"b"});
  const std::vector<model::StartState> measured = diagnose::MeasuredStarts(rig.context.runs);
  diagnose::Explanation stuck = diagnose::Explain(rig.context, hypothesis, measured, {});
  const double reached = stuck.fitted.sum;
  EXPECT_EQ(diagnose::RefitFromOtherStarts(rig.context, stuck, {}).fitted.sum, reached);

  stuck.fitted.sum *= 20;  // as if another start had trapped it
  const diagnose::Explanation mended = diagnose::RefitFromOtherStarts(rig.context, stuck, {});
  EXPECT_NEAR(mended.fitted.sum, reached, 1e-3 * reached);
}

// Tests that a value which what was known held while the gap was large is found once the gap is small.
TEST(RefitFromGivenValues, WeighsWhatIsKnownByTheGapThatIsLeft) {
  model::ModelDescription truth = Table1With();
  truth.parameters.b *= 1.4;
  const std::vector<diagnose::RunData> runs = ClampedPair(truth, 0.5, 1);
  diagnose::SearchContext context;
  context.given = Table1With();
  context.runs = context.held_out = PointersTo(runs);
  context.windows = true;
  diagnose::Hypothesis hypothesis = WithFree(Table1With(), {"b"});
  hypothesis.changes = {{"amp.bias", {}, ""}};
  const std::vector<model::StartState> measured = diagnose::MeasuredStarts(context.runs);
  hypothesis.known = diagnose::KnownAt(context, 1e10);  // as before a valve was found
  const diagnose::Explanation held = diagnose::Explain(context, hypothesis, measured, {});
  ASSERT_LT(held.fitted.hypothesis.model.parameters.b, 1.1 * Table1().b);
  const diagnose::Explanation found =
      diagnose::RefitFromGivenValues(context, held, diagnose::FitToCompare(1));
  EXPECT_NEAR(found.fitted.hypothesis.model.parameters.b, truth.parameters.b, 0.02 * truth.parameters.b);
  EXPECT_LT(found.fitted.sum, 0.5 * held.fitted.sum);
  EXPECT_LT(found.fitted.hypothesis.known->weight, 1e-3 * hypothesis.known->weight);
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
