// From a search's results to the verdict, on a small search: a rig with a drag that its model lacks.
#include "diagnose/verdict/conclusion.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/verdict/evidence.h"
#include "diagnose/verdict/ranking.h"
#include "diagnose/verdict/run_curves.h"
#include "tests/diagnose/verdict/small_search.h"

namespace hydro::testing {
namespace {

// Tests that the ranking has every candidate once: the chosen one first, without a reason, the others each
// with one.
TEST(Ranking, TakenFirstOthersWithAReason) {
  SmallSearch& small = OfADrag();
  const auto weights = diagnose::WeightsOf(small.context, small.Found(), {});
  const std::vector<diagnose::Candidate> ranking =
      diagnose::Ranking(small.context, small.search, weights, {});
  ASSERT_EQ(ranking.size(), 4u);
  EXPECT_EQ(ranking[0].id, "pump.quadratic_drag");
  EXPECT_EQ(ranking[0].rejected_because, "");
  EXPECT_LT(ranking[0].held_out, 1.2);
  EXPECT_LT(ranking[0].p_value, 1e-6);
  EXPECT_GT(ranking[0].weight, 0.9);
  double sum = 0;
  for (const diagnose::Candidate& candidate : ranking) sum += candidate.weight;
  EXPECT_NEAR(sum, 1, 1e-9);
  std::vector<std::string> others;
  for (size_t i = 1; i < ranking.size(); ++i) {
    EXPECT_NE(ranking[i].rejected_because, "") << ranking[i].id;
    others.push_back(ranking[i].id);
  }
  EXPECT_THAT(others, ::testing::UnorderedElementsAre("valve.relief", "parameter beta", "as given"));
}

// Tests the conclusion: the verdict, the effect with its value in its interval, the gaps, the place, and
// whose runs they were.
TEST(Conclusion, NamesTheDrag) {
  SmallSearch& small = OfADrag();
  const diagnose::Diagnosis d = diagnose::Conclude(small.context, small.Found());
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNamed) << d.sentence;
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects[0].id, "pump.quadratic_drag");
  EXPECT_TRUE(d.effects[0].tied_with.empty());
  ASSERT_EQ(d.effects[0].parameters.size(), 1u);
  EXPECT_LE(d.effects[0].parameters[0].low, 2e-4);
  EXPECT_GE(d.effects[0].parameters[0].high, 2e-4);
  EXPECT_DOUBLE_EQ(d.held_out.before, d.held_out.refit_only) << "the refit given was the model as it is";
  EXPECT_GT(d.held_out.before, 2 * d.held_out.after);
  ASSERT_FALSE(d.location.empty());
  EXPECT_EQ(d.location[0].balance, "pump_torque");
  EXPECT_THAT(d.sentence, ::testing::StartsWith("Missing: "));
  EXPECT_THAT(d.runs, ::testing::ElementsAre("clamped 0"));
  EXPECT_THAT(d.held_out_runs, ::testing::ElementsAre("clamped 1"));
  EXPECT_EQ(d.samples, 500u);
  EXPECT_THAT(small.stages, ::testing::Contains("intervals"));
}

// Tests that a model which explains its runs is said to lack nothing, and is left as it is.
TEST(Conclusion, NothingMissing) {
  SmallSearch small(Table1With());
  const diagnose::Diagnosis d = diagnose::Conclude(small.context, small.Found());
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNothingMissing) << d.sentence;
  EXPECT_TRUE(d.effects.empty());
  EXPECT_TRUE(d.parameters.empty());
  EXPECT_TRUE(d.location.empty());
  EXPECT_EQ(d.model.parameters.beta, Table1().beta);
  EXPECT_NEAR(d.held_out.before, 1, 0.1);
}

// Tests that a gap that nothing tried closes is called unexplained, with its place.
TEST(Conclusion, Unexplained) {
  SmallSearch& small = OfADrag();
  diagnose::WideSearch none = small.Found();
  none.search.best = none.search.given;
  const diagnose::Diagnosis d = diagnose::Conclude(small.context, none);
  EXPECT_EQ(d.verdict, diagnose::Verdict::kUnexplained);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_DOUBLE_EQ(d.held_out.before, d.held_out.after);
  EXPECT_FALSE(d.location.empty());
}

// Tests that each signal's gap is in its own unit: at the noise with what was found, above it before.
TEST(RunCurves, GapsBySignal) {
  SmallSearch& small = OfADrag();
  const std::vector<diagnose::SignalGap> gaps =
      diagnose::SignalGaps(small.context, small.search.given, small.search.given, small.search.best);
  EXPECT_EQ(gaps.size(), small.runs[0].signals.size());
  for (const diagnose::SignalGap& gap : gaps) {
    EXPECT_NEAR(gap.noise, small.runs[0].Find(gap.channel)->noise, 0.2 * gap.noise);
    EXPECT_NEAR(gap.held_out.after, gap.noise, 0.5 * gap.noise);
    EXPECT_GT(gap.held_out.before, gap.held_out.after);
    EXPECT_EQ(gap.held_out.before, gap.held_out.refit_only);
  }
}

// Tests that there is a picture for each run, fitted ones first, with the measurement and both predictions.
TEST(RunCurves, OneARun) {
  SmallSearch& small = OfADrag();
  const std::vector<diagnose::RunCurves> curves =
      diagnose::CurvesOf(small.context, small.search.given, small.search.best);
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[0].run, "clamped 0");
  EXPECT_FALSE(curves[0].held_out);
  EXPECT_EQ(curves[1].run, "clamped 1");
  EXPECT_TRUE(curves[1].held_out);
  for (const diagnose::RunCurves& one : curves) {
    EXPECT_EQ(one.time.size(), 500u);
    EXPECT_EQ(one.voltage.size(), 500u);
    for (const diagnose::RunCurves::Curve& curve : one.curves) {
      ASSERT_EQ(curve.measured.size(), 500u);
      double before = 0, after = 0;
      for (size_t k = 0; k < 500; ++k) {
        if (std::isnan(curve.measured[k])) continue;
        before += std::pow(curve.before[k] - curve.measured[k], 2);
        after += std::pow(curve.after[k] - curve.measured[k], 2);
      }
      EXPECT_LT(after, before);
    }
  }
}

}  // namespace
}  // namespace hydro::testing
