// Tests that values are refined by simulation, and that a refit never predicts worse.
#include "diagnose/prove/refined_values.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/terms/state.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using diagnose::ProvedSet;
using diagnose::RunData;

model::ModelDescription With(double drag, double bulk = 1) {
  model::ModelDescription model = Table1With();
  model.parameters.b *= drag;
  model.parameters.beta *= bulk;
  return model;
}

// Two clamped runs of Table 1, one of them held out.
class RefinedTest : public ::testing::Test {
 protected:
  RefinedTest() : runs_(ClampedPair(Table1With(), 2, 61)) {
    context_.given = Table1With();
    context_.runs = {&runs_[0]};
    context_.held_out = {&runs_[1]};
    context_.sizes = diagnose::SizesOf(context_.given, context_.runs);
    windows_ = ProofWindowsOf(context_);
  }

  ProvedSet SetOf(const model::ModelDescription& model, const std::vector<std::string>& free) const {
    ProvedSet set;
    set.hypothesis = WithFree(model, free);
    JudgeSet(windows_, 1, &set);
    return set;
  }

  ProvedSet Refined(ProvedSet set) const {
    const std::vector<RunData> fitted = WithDiscrepancy(windows_.fitted, set.hypothesis.model, 1);
    RefineValues(context_, diagnose::PointersTo(fitted), windows_, diagnose::kComparedValues, &set);
    return set;
  }

  std::vector<RunData> runs_;
  diagnose::ProofContext context_;
  diagnose::ProofWindows windows_;
};

// Tests that wrong values are mended, and that windows of a run that they were not fitted to are predicted
// better.
TEST_F(RefinedTest, WrongValuesAreMended) {
  const ProvedSet wrong = SetOf(With(1.4, 0.8), {"b", "beta", "T_s"});
  const ProvedSet refined = Refined(wrong);
  EXPECT_NEAR(refined.hypothesis.model.parameters.b, Table1().b, 0.03 * Table1().b);
  EXPECT_NEAR(refined.hypothesis.model.parameters.beta, Table1().beta, 0.03 * Table1().beta);
  EXPECT_LT(diagnose::TypicalGap(refined.near), 0.8 * diagnose::TypicalGap(wrong.near));
  EXPECT_NEAR(diagnose::TypicalGap(refined.near), 1, 0.3);
}

// Tests that a refit never predicts worse, whatever it starts from.
TEST_F(RefinedTest, NeverWorse) {
  for (const double drag : {0.2, 1.0, 1.02, 5.0}) {
    for (const char* free : {"b", "c_I"}) {
      const ProvedSet before = SetOf(With(drag), {free});
      const ProvedSet after = Refined(before);
      EXPECT_LE(diagnose::TypicalGap(after.near), 1.000001 * diagnose::TypicalGap(before.near))
          << drag << free;
    }
  }
}

// Tests that what cannot be simulated, and what has nothing free, stays as it is.
TEST_F(RefinedTest, NothingToRefine) {
  const ProvedSet held = SetOf(With(1.4), {});
  EXPECT_EQ(Refined(held).hypothesis.model.parameters.b, With(1.4).parameters.b);
  ProvedSet wrong = SetOf(With(1.4), {"b"});
  RefineValues(context_, {}, windows_, diagnose::kComparedValues, &wrong);
  EXPECT_EQ(wrong.hypothesis.model.parameters.b, With(1.4).parameters.b);
}

// Tests that the noise that counts is the sensors' where the model is true, more where it is not, and never
// less.
TEST_F(RefinedTest, DiscrepancyIsCountedAsNoise) {
  const std::vector<RunData> plain = WithDiscrepancy(windows_.fitted, Table1With(), 1),
                             raised = WithDiscrepancy(windows_.fitted, With(3), 2);
  ASSERT_EQ(plain.size(), windows_.fitted.size());
  ASSERT_EQ(raised.size(), windows_.fitted.size());
  for (size_t w = 0; w < plain.size(); ++w) {
    for (size_t s = 0; s < plain[w].signals.size(); ++s) {
      const double noise = windows_.fitted[w]->signals[s].noise;
      EXPECT_GE(plain[w].signals[s].noise, noise);
      EXPECT_LE(plain[w].signals[s].noise, 1.2 * noise);
      EXPECT_GE(raised[w].signals[s].noise, noise);
    }
    EXPECT_GT(raised[w].Find(model::Channel::kMotorSpeed)->noise,
              2 * windows_.fitted[w]->Find(model::Channel::kMotorSpeed)->noise);
  }
  const model::ModelDescription impossible = Table1With({{"amp.bias", {{"bias", std::nan("")}}, {}}});
  EXPECT_TRUE(WithDiscrepancy(windows_.fitted, impossible, 1).empty());
}

// Tests that base values are held near what is known of them, unless the set itself says that they are
// others.
TEST_F(RefinedTest, KnownOfValues) {
  diagnose::Hypothesis hypothesis = WithFree(With(1), {"b", "beta"});
  EXPECT_NE(KnownOfValues(context_, context_.runs, hypothesis, 100), nullptr);
  hypothesis.changes = {{"", {}, "b"}, {"", {}, "beta"}};
  EXPECT_EQ(KnownOfValues(context_, context_.runs, hypothesis, 100), nullptr);
}

// Tests that windows begin where the model says, near what was measured.
TEST_F(RefinedTest, CorrectedStarts) {
  const std::vector<model::StartState> starts = CorrectedStarts(Table1With(), windows_.fitted, 1);
  ASSERT_EQ(starts.size(), windows_.fitted.size());
  for (size_t w = 0; w < starts.size(); ++w)
    EXPECT_NEAR(starts[w][model::kP1], windows_.fitted[w]->start[model::kP1], 10);
  const model::ModelDescription impossible = Table1With({{"amp.bias", {{"bias", std::nan("")}}, {}}});
  EXPECT_EQ(CorrectedStarts(impossible, windows_.fitted, 1).front(), windows_.fitted.front()->start);
}

}  // namespace
}  // namespace hydro::testing
