#include "tune/search/step_judge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/terms/parameter_info.h"
#include "tests/tune/search/configs.h"
#include "tune/search/simulated_step.h"

namespace hydro::tune {
namespace {

// Tests a trial against the stack itself, with noise and a D/A converter: to the last digits that rounding
// leaves.
TEST(StepJudge, TriesAStepAsTheStackRunsIt) {
  const StepJudge judge(Retuned({"position.dac_bits=12"}), {.noise = false});
  for (const double step : {0.05, 0.3}) {
    const StepResult tried = judge.Try(GainsOf(judge.config()), judge.Nominal(step));
    const StepResult run = SimulateStep(judge.config(), judge.Nominal(step));
    EXPECT_TRUE(tried.settled);
    EXPECT_NEAR(tried.settling, run.settling, 3e-4) << step;
    EXPECT_NEAR(tried.overshoot_percent, run.overshoot_percent, 0.01) << step;
    EXPECT_NEAR(tried.ratio, run.ratio, 2e-3) << step;
  }
}

// Tests the known numbers of config/retuned.toml.
TEST(StepJudge, FindsTheRatiosOfTheRetunedLoop) {
  const StepJudge judge(Retuned(), {});
  const StepVerdict verdict = judge.Judge(GainsOf(judge.config()));
  EXPECT_NEAR(judge.Try(GainsOf(judge.config()), judge.Nominal(0.1)).ratio, 1.05, 0.01);
  EXPECT_NEAR(verdict.ratio, 1.68, 0.01);
  EXPECT_GT(verdict.uncertain_ratio, verdict.ratio);
  EXPECT_NEAR(verdict.overshoot_percent, 19.4, 0.5);
  EXPECT_GT(verdict.score(), verdict.ratio);
}

TEST(StepJudge, TriesTheStepsThatAreAskedFor) {
  const StepJudge judge(Retuned(), {.goals = {.step = 0.2}});
  EXPECT_EQ(judge.steps(), (std::vector<double>{0.2 * 0.8, 0.2, 0.2 * 1.25}));
  EXPECT_EQ(judge.goal_step(), 0.2);
  EXPECT_EQ(StepJudge(Retuned(), {}).goal_step(), 0.1);
}

// Tests that the samples of the model spread as [uncertainty] says, the same every time.
TEST(StepJudge, SamplesWhatTheModelDoesNotKnow) {
  model::ModelDescription model = experiments::ShippedModel("table1");
  model.uncertainty["J"] = 0.001;
  const StepJudge judge(Retuned({}, model), {.samples = 50});
  ASSERT_EQ(judge.models().size(), 51U);
  EXPECT_EQ(judge.models().front().parameters.J, model.parameters.J);
  double J = 0;
  double T_s = 0;
  for (const model::ModelDescription& sample : judge.models()) {
    J = std::max(J, std::fabs(sample.parameters.J / model.parameters.J - 1));
    T_s = std::max(T_s, std::fabs(sample.parameters.T_s / model.parameters.T_s - 1));
    EXPECT_EQ(sample.parameters.mgl, 0);
  }
  EXPECT_GT(J, 0);
  EXPECT_LT(J, 0.0021);
  EXPECT_GT(T_s, 0.3);
  const StepJudge again(Retuned({}, model), {.samples = 50});
  EXPECT_EQ(again.models()[17].parameters.T_s, judge.models()[17].parameters.T_s);
}

// Tests that of two gains with which the arm never settles in some case, those are better that settle in
// more.
TEST(StepJudge, CountsTheStepsThatNeverSettle) {
  const StepJudge judge(Retuned(), {.samples = 0});
  Gains few = GainsOf(judge.config());
  few.as_configured = false;
  few.c2 = 400;  // swings after half of the steps
  Gains all = few;
  all.c2 = 150;
  const StepVerdict some = judge.Judge(few), none = judge.Judge(all);
  EXPECT_NEAR(some.unsettled, 0.5, 0.1);
  EXPECT_EQ(none.unsettled, 1);
  EXPECT_LT(some.score(), none.score());
  EXPECT_GE(some.ratio, kNeverSettled);
  EXPECT_EQ(judge.Judge(GainsOf(judge.config())).unsettled, 0);
}

TEST(StepJudge, MarksRunsThatALimitWouldEnd) {
  const StepJudge slow(Retuned({"limits.motor_speed=200"}), {.goals = {.step = 0.3}});
  EXPECT_GT(slow.Judge(GainsOf(slow.config())).ratio, kStopped);
}

// Tests the braking curve on the model: what a straight line cannot do.
TEST(StepJudge, SettlesAllStepsWithABrakingCurve) {
  const StepJudge judge(Retuned(), {});
  const Gains gains = {
      .natural_frequency = 150, .damping_ratio = 0.5, .c1 = 39258, .c2 = 1484.7, .deceleration = 3.042};
  const StepVerdict verdict = judge.Judge(gains);
  EXPECT_LT(verdict.ratio, 1.1);
  EXPECT_LT(verdict.overshoot_percent, 1);
  // On the stack itself.
  for (const double step : judge.steps()) {
    const StepResult run = SimulateStep(With(judge.config(), gains), judge.Nominal(step));
    EXPECT_LT(run.ratio, 1.1) << step;
    EXPECT_NEAR(run.ratio, judge.Try(gains, judge.Nominal(step)).ratio, 2e-3) << step;
  }
}

// Tests that noise reaches the loops, and is the configuration's own where it has some.
TEST(StepJudge, AddsNoiseWhenAsked) {
  const StepJudge plain(Retuned(), {});
  const StepJudge noisy(Retuned(), {.noise = true});
  EXPECT_EQ(plain.config().noise.p1_psi, 0);
  EXPECT_NEAR(noisy.config().noise.p1_psi, 1, 0.01);
  const StepJudge own(Retuned({"noise.p2=3"}), {.noise = true});
  EXPECT_EQ(own.config().noise.p1_psi, 0);
  EXPECT_EQ(own.config().noise.p2_psi, 3);
  const Gains gains = GainsOf(plain.config());
  EXPECT_NE(noisy.Try(gains, noisy.Nominal(0.1)).error, plain.Try(gains, plain.Nominal(0.1)).error);
}

}  // namespace
}  // namespace hydro::tune
