#include "diagnose/recording/windows.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/fit/fit.h"
#include "diagnose/say/gaps.h"
#include "model/terms/state.h"
#include "tests/diagnose/noisy_rig.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using ::testing::SizeIs;

// Two seconds at 1 kHz of the model itself under a slow square wave; the motor's angle is not measured.
RunData Simulated(const model::ModelDescription& model) {
  testing::NoisyRig rig;
  rig.model = model;
  rig.angle_measured = false;
  return rig.Record("square", model::Shaft::kClamped, 0, 2.001, false,
                    [](double t) { return std::fmod(t, 0.5) < 0.25 ? 2 : -1.5; });
}

// Tests that windows cover a run without gaps, warm-ups aside, and keep its clock, noise and integrated
// angle.
TEST(Windows, CoverTheRun) {
  const model::ModelDescription model = {"Table 1", testing::Table1(), {}};
  const RunData run = Simulated(model);
  const std::vector<RunData> windows = WindowsOf(run, 0.4, model.parameters);
  ASSERT_THAT(windows, SizeIs(4));  // 0.1 s to warm up, then 4 of 0.4 s in 2 s
  double end = 0.1;
  for (const RunData& window : windows) {
    ASSERT_THAT(window.signals, SizeIs(3));
    const SignalData& p1 = *window.Find(model::Channel::kP1);
    EXPECT_EQ(p1.noise, run.Find(model::Channel::kP1)->noise);
    EXPECT_NEAR(static_cast<double>(p1.valid), 400, 1);
    size_t first = 0;
    while (std::isnan(p1.values[first])) ++first;
    EXPECT_NEAR(window.stimulus.time[first], end, 0.0015);
    EXPECT_NEAR(window.stimulus.time.front(), end - 0.1, 0.0015);
    end = window.stimulus.time.back();
    EXPECT_TRUE(window.start_free[model::kMotorAngle]);
  }
  EXPECT_GT(std::abs(windows.back().start[model::kMotorAngle]), 1);
}

// Tests that a model predicts its own windows to the noise, and that one with friction twice as large does
// not.
TEST(Windows, TellAWrongModel) {
  const model::ModelDescription model = {"Table 1", testing::Table1(), {}};
  model::ModelDescription wrong = model;
  wrong.parameters.T_s *= 2;
  const RunData run = Simulated(model);
  for (const RunData& window : WindowsOf(run, 0.4, model.parameters)) {
    const auto gap = [&window](const model::ModelDescription& by) {
      Hypothesis hypothesis;
      hypothesis.model = by;
      const Fitted fitted = Fit(hypothesis, {&window}, {window.start}, {});
      return fitted.ok() ? fitted.squared_gap() : 1e9;
    };
    EXPECT_LT(gap(model), 1.3);
    EXPECT_GT(gap(wrong), 2);
  }
}

// Tests that a line's wave that is under way where a window begins is no gap: it rings for longer than any
// warm-up.
TEST(Windows, WavesAreUnderWay) {
  const model::ModelDescription model = {
      "Table 1",
      testing::Table1(),
      {{"line.wave", {{"frequency", 110.0}, {"volume_fraction", 0.3}, {"damping", 0.01}}, {}}}};
  const RunData run = Simulated(model);
  std::vector<RunData> windows = WindowsOf(run, 0.1, model.parameters);
  ASSERT_GT(windows.size(), 10);
  Hypothesis hypothesis;
  hypothesis.model = model;
  for (const size_t w : {4, 9}) {
    RunData& window = windows[w];
    EXPECT_TRUE(window.begins_within);
    EXPECT_LT(Fit(hypothesis, {&window}, {window.start}, {}).squared_gap(), 1.4);
    window.begins_within = false;  // as if it began at rest
    EXPECT_GT(Fit(hypothesis, {&window}, {window.start}, {}).squared_gap(), 2.5);
  }
  EXPECT_FALSE(windows[0].begins_within);
}

// Tests that what drifts over a run drifts on in its windows, whatever the recorder's clock said when the run
// began: one rate holds for all of them, of a sensor and of the oil.
TEST(Windows, GoOnWithTheTimeOfTheRun) {
  model::ModelDescription model = {"Table 1", testing::Table1(), {}};
  model.effects = {{"sensor.pressure_drift", {{"p1", 30}, {"p2", -20}}, {}},
                   {"fluid.warming", {{"rate", 0.5}}, {}}};
  RunData run = Simulated(model);
  for (double& time : run.stimulus.time) time += 1e4;
  run.stimulus.begin += 1e4;
  const std::vector<RunData> windows = WindowsOf(run, 0.4, model.parameters);
  ASSERT_THAT(windows, SizeIs(4));
  for (const RunData& window : windows) {
    EXPECT_EQ(window.stimulus.begin, 1e4);
    const Fitted fitted = Fit({model, {}, {}, {}}, {&window}, {window.start}, {});
    ASSERT_TRUE(fitted.ok()) << fitted.failure;
    EXPECT_LT(fitted.squared_gap(), 1.3);
  }
}

// Tests that the rest of a run that was cut keeps the time of its first sample.
TEST(Windows, ACutRunKeepsItsBegin) {
  runs::MeasuredRun run;
  for (int k = 0; k < 200; ++k) run.time.push_back(5 + 0.01 * k);
  run.voltage.values.assign(200, 0);
  EXPECT_EQ(StimulusOf(run).begin, 5);
  run.Keep(100, 200);
  run.Keep(20, 100);
  EXPECT_EQ(StimulusOf(run).begin, 5);
  EXPECT_NEAR(StimulusOf(run).time.front(), 6.2, 1e-12);
}

// Tests that windows are spread evenly, and that every other one can be chosen.
TEST(Windows, EvenlySpread) {
  std::vector<RunData> windows(10);
  EXPECT_THAT(EvenlySpread(windows, 20), SizeIs(10));
  const std::vector<const RunData*> odd = EvenlySpread(windows, 20, 1, 2);
  ASSERT_THAT(odd, SizeIs(5));
  EXPECT_EQ(odd[4], &windows[9]);
  const std::vector<const RunData*> some = EvenlySpread(windows, 4);
  ASSERT_THAT(some, SizeIs(4));
  EXPECT_EQ(some[0], &windows[0]);
  EXPECT_EQ(some[3], &windows[7]);
}

// Tests that the gaps over horizons come down where the model is right, for fitted and held-out runs.
TEST(Horizons, ShowTheRightModel) {
  const model::ModelDescription model = {"Table 1", testing::Table1(), {}};
  model::ModelDescription wrong = model;
  wrong.parameters.T_s *= 2;
  const RunData run = Simulated(model);
  ProofContext context;
  context.runs = {&run};
  const auto gaps_of = [&](const std::vector<model::ModelDescription>& models) {
    Proof proof;
    for (const model::ModelDescription& by : models) proof.sets.emplace_back().hypothesis.model = by;
    proof.values = 1;
    proof.best = 2;
    return HorizonGaps(context, proof);
  };
  const std::vector<HorizonGap> gaps = gaps_of({wrong, wrong, model});
  ASSERT_THAT(gaps, SizeIs(3));
  for (const HorizonGap& gap : gaps) {
    EXPECT_GT(gap.fit.before, 1.3) << gap.seconds;
    EXPECT_EQ(gap.fit.before, gap.fit.refit_only);
    EXPECT_LT(gap.fit.after, 1.15) << gap.seconds;
    EXPECT_EQ(gap.held_out.after, gap.fit.after);
    EXPECT_THAT(gap.signals, SizeIs(3));
  }
  EXPECT_EQ(gaps[0].seconds, 0.1);
  EXPECT_EQ(gaps[1].seconds, 0.4);
  // What one model cannot be simulated over is left out of its own gap alone.
  model::ModelDescription stiff = model;
  stiff.parameters.beta *= 1e9;
  const HorizonGap gap = gaps_of({stiff, wrong, model})[1];
  EXPECT_TRUE(std::isnan(gap.typical.before));
  EXPECT_GT(gap.typical.refit_only, 1.3);
  EXPECT_LT(gap.typical.after, 1.15);
}

}  // namespace
}  // namespace hydro::diagnose
