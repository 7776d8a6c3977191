// From a proof to the verdict, on a small one: a rig with a drag that its model lacks, judged by a whole run.
#include "diagnose/say/conclusion.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/say/run_curves.h"
#include "tests/diagnose/say/made_up.h"

namespace hydro::testing {
namespace {

// A fitted run and one held out; the model as given, and a valve, a value and the drag fitted to it.
struct SmallProof {
  std::vector<diagnose::RunData> runs, held_out;
  diagnose::ProofContext context;
  diagnose::Proof proof;
  std::vector<std::string> stages;

  explicit SmallProof(const model::ModelDescription& truth) {
    runs = ClampedPair(truth, 0.5, 5);
    held_out.push_back(std::move(runs.back()));
    runs.pop_back();
    context.given = Table1With();
    context.runs = PointersTo(runs);
    context.held_out = PointersTo(held_out);
    context.sizes = diagnose::SizesOf(context.given, context.runs);
    context.changes = {kDrag, kRelief, {"", {}, "beta"}};
    context.report_progress = [this](const diagnose::Progress& progress) {
      stages.push_back(progress.stage);
    };
    proof.runs = {held_out[0].name};
    proof.told_runs = context.runs;
    diagnose::Hypothesis given;
    given.model = context.given;
    Add(given);
    for (size_t c = context.changes.size(); c-- > 0;) {
      for (const diagnose::Hypothesis& start :
           With(given, context.changes[c], context.sizes, MovableValues(context)))
        Add(start);
    }
    proof.best = proof.sets.size() - 1;
  }

  diagnose::Proof Nothing() const {
    diagnose::Proof nothing = proof;
    nothing.best = nothing.given;
    return nothing;
  }

 private:
  void Add(const diagnose::Hypothesis& start) {
    const diagnose::Fitted fitted =
        Fit(start, context.runs, diagnose::MeasuredStarts(context.runs), diagnose::FineFit(1));
    if (!fitted.ok()) return;
    diagnose::ProvedSet& set = proof.sets.emplace_back();
    set.hypothesis = fitted.hypothesis;
    set.near = diagnose::GapsOfEach(fitted.hypothesis.model, context.held_out, 1);
    proof.told = fitted;
  }
};

SmallProof& OfADrag() {
  static SmallProof small(Table1With({{"pump.quadratic_drag", {{"k", 2e-4}}, {}}}));
  return small;
}

// Tests the conclusion: the verdict, the effect with its value in its interval, the gaps, the place, and
// whose runs they were.
TEST(Conclusion, NamesTheDrag) {
  SmallProof& small = OfADrag();
  const diagnose::Diagnosis d = diagnose::Conclude(small.context, small.proof);
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNamed) << d.sentence;
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects[0].id, "pump.quadratic_drag");
  EXPECT_TRUE(d.effects[0].tied_with.empty());
  EXPECT_GT(d.effects[0].share, 0.9);
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
  SmallProof small(Table1With());
  const diagnose::Diagnosis d = diagnose::Conclude(small.context, small.Nothing());
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNothingMissing) << d.sentence;
  EXPECT_TRUE(d.effects.empty());
  EXPECT_TRUE(d.parameters.empty());
  EXPECT_TRUE(d.location.empty());
  EXPECT_EQ(d.model.parameters.beta, Table1().beta);
  EXPECT_NEAR(d.held_out.before, 1, 0.1);
}

// Tests that a gap that nothing tried closes is called unexplained, with its place.
TEST(Conclusion, Unexplained) {
  SmallProof& small = OfADrag();
  const diagnose::Diagnosis d = diagnose::Conclude(small.context, small.Nothing());
  EXPECT_EQ(d.verdict, diagnose::Verdict::kUnexplained);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_DOUBLE_EQ(d.held_out.before, d.held_out.after);
  EXPECT_FALSE(d.location.empty());
}

// Tests that each signal's gap is in its own unit: at the noise with what was found, above it before.
TEST(DescribeGaps, BySignal) {
  SmallProof& small = OfADrag();
  diagnose::Diagnosis d;
  DescribeGaps(small.context, OverWholeRuns(small.context, small.proof), &d);
  EXPECT_EQ(d.signals.size(), small.runs[0].signals.size());
  for (const diagnose::SignalGap& gap : d.signals) {
    EXPECT_NEAR(gap.noise, small.runs[0].Find(gap.channel)->noise, 0.2 * gap.noise);
    EXPECT_NEAR(gap.held_out.after, gap.noise, 0.5 * gap.noise);
    EXPECT_GT(gap.held_out.before, gap.held_out.after);
    EXPECT_EQ(gap.held_out.before, gap.held_out.refit_only);
  }
}

// Tests that the gaps of windows are there for the horizons that the runs are long enough for, and closed
// with what was found.
TEST(HorizonGaps, AsLongAsTheRuns) {
  SmallProof& small = OfADrag();
  const std::vector<diagnose::HorizonGap> horizons = HorizonGaps(small.context, small.proof);
  ASSERT_EQ(horizons.size(), 2u);
  EXPECT_EQ(horizons[0].seconds, 0.1);
  EXPECT_EQ(horizons[1].seconds, 0.4);
  for (const diagnose::HorizonGap& horizon : horizons) {
    EXPECT_NEAR(horizon.typical.after, 1, 0.2);
    EXPECT_NEAR(horizon.held_out.after, 1, 0.2);
    EXPECT_GT(horizon.held_out.before, 1.2 * horizon.held_out.after);
    EXPECT_EQ(horizon.signals.size(), small.runs[0].signals.size());
  }
}

// Tests that there is a picture for each run, fitted ones first, with the measurement and both predictions.
TEST(RunCurves, OneARun) {
  SmallProof& small = OfADrag();
  const std::vector<diagnose::RunCurves> curves =
      CurvesOf(small.context, small.proof, OverWholeRuns(small.context, small.proof));
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[0].run, "clamped 0");
  EXPECT_FALSE(curves[0].held_out);
  EXPECT_EQ(curves[1].run, "clamped 1");
  EXPECT_TRUE(curves[1].held_out);
  for (const diagnose::RunCurves& one : curves) {
    EXPECT_EQ(one.time.size(), 500u);
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

// Tests that the stretch is a 25th of the fitted run or 60 samples, with the model near the measurement with
// the effect and away from it without, in the signal that shows the effect; an effect that the model does not
// have shows nowhere.
TEST(StretchOf, ShowsWhereTheEffectMatters) {
  SmallProof& small = OfADrag();
  const diagnose::WholeRuns whole = OverWholeRuns(small.context, small.proof);
  const auto stretch = StretchOf(small.context, small.proof, whole, "pump.quadratic_drag");
  ASSERT_TRUE(stretch.has_value());
  EXPECT_EQ(stretch->run, "clamped 0");
  ASSERT_EQ(stretch->time.size(), 60u);
  ASSERT_EQ(stretch->with.size(), 60u);
  double with = 0, without = 0;
  for (size_t i = 0; i < 60; ++i) {
    if (std::isnan(stretch->measured[i])) continue;
    with += std::pow(stretch->with[i] - stretch->measured[i], 2);
    without += std::pow(stretch->without[i] - stretch->measured[i], 2);
  }
  EXPECT_GT(without, 4 * with);
  EXPECT_FALSE(StretchOf(small.context, small.proof, whole, "amp.lag").has_value());
}

}  // namespace
}  // namespace hydro::testing
