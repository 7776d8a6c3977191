// What the verdict rests on: intervals, significance, and what runs can tell.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "diagnose/fit/intervals.h"
#include "diagnose/fit/prior.h"
#include "tests/diagnose/prepare_run.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

// Noise in which each value keeps the fraction `phi` of the one before; standard deviation 1.
std::vector<double> Noise(size_t samples, double phi, std::mt19937_64* random) {
  std::normal_distribution<double> normal;
  std::vector<double> noise = {normal(*random)};
  while (noise.size() < samples)
    noise.push_back(phi * noise.back() + std::sqrt(1 - phi * phi) * normal(*random));
  return noise;
}

constexpr double kPressureNoise = 1.5, kSpeedNoise = 0.3;

// A clamped run with such noise on pressures and speed. `exact` is Table 1's response to its stimulus.
diagnose::RunData WithNoise(const diagnose::RunData& like, const model::Response& exact, double phi,
                            uint64_t seed) {
  runs::MeasuredRun run = like.measured;
  run.motor_angle = {};
  std::mt19937_64 random(seed);
  const auto noisy = [&](model::Channel channel, double size, runs::MeasuredSignal* signal) {
    signal->values = exact.values[static_cast<size_t>(channel)];
    const std::vector<double> noise = Noise(signal->values.size(), phi, &random);
    for (size_t i = 0; i < noise.size(); ++i) signal->values[i] += size * noise[i];
  };
  noisy(model::Channel::kMotorSpeed, kSpeedNoise, &run.motor_speed);
  noisy(model::Channel::kP1, kPressureNoise, &run.p1);
  noisy(model::Channel::kP2, kPressureNoise, &run.p2);
  return diagnose::PrepareRun(run, Table1());
}

// Two clamped runs of Table 1 without noise.
struct ExactPair {
  explicit ExactPair(double duration) : runs(ClampedPair(Table1With(), duration, 1)) {
    for (const diagnose::RunData& run : runs)
      exact.push_back(model::Respond(Table1With(), run.stimulus, Start(run), {}, {}));
  }
  static model::StartState Start(const diagnose::RunData& run) {
    return {0, 0, 100, 100, run.stimulus.arm_angle, 0};
  }
  std::vector<diagnose::RunData> With(double phi, uint64_t seed) const {
    std::vector<diagnose::RunData> noisy;
    for (size_t r = 0; r < runs.size(); ++r) noisy.push_back(WithNoise(runs[r], exact[r], phi, 2 * seed + r));
    return noisy;
  }

  std::vector<diagnose::RunData> runs;
  std::vector<model::Response> exact;
};

constexpr uint64_t kSeeds = 30;

// For how many of 30 noises the true values of b, T_s and beta lie within their intervals.
std::vector<int> Covered(double phi, double duration) {
  const ExactPair pair(duration);
  std::vector<int> covered(3, 0);
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const std::vector<diagnose::RunData> runs = pair.With(phi, seed);
    const diagnose::Fitted fitted =
        diagnose::Fit(WithFree(Table1With(), {"b", "T_s", "beta"}), PointersTo(runs), StartsOf(runs), {});
    EXPECT_TRUE(fitted.ok());
    const std::vector<diagnose::Interval> intervals = diagnose::Intervals(fitted, PointersTo(runs), 1);
    const model::Parameters p = Table1();
    const double truth[] = {p.b, p.T_s, p.beta};
    for (size_t i = 0; i < 3; ++i) {
      covered[i] += intervals[i].low <= truth[i] && truth[i] <= intervals[i].high;
      const double value = fitted.hypothesis.Free()[i].value;
      EXPECT_LT(intervals[i].high - intervals[i].low, 0.3 * value);
    }
  }
  return covered;
}

// Tests that 95 % intervals hold the truth about that often; 26 of 30 are reached in 98 of 100 cases.
TEST(Intervals, HoldTheTruth) {
  for (const int covered : Covered(0, 0.4)) EXPECT_GE(covered, 26);
}

// Tests the same with noise that is not white.
TEST(Intervals, HoldTheTruthWithCorrelatedNoise) {
  for (const int covered : Covered(0.8, 1)) EXPECT_GE(covered, 26);
}

// Tests that a time is never claimed more certain than sensors are immediate, however little noise there is.
TEST(Intervals, TimesAreNotSharperThanSensors) {
  const model::ModelDescription lagging = Table1With({{"amp.lag", {{"tau", 0.002}}, {}}});
  const std::vector<diagnose::RunData> runs = ClampedPair(lagging, 2, 1);
  const diagnose::Fitted fitted = diagnose::Fit(WithFree(lagging, {}), PointersTo(runs), StartsOf(runs), {});
  ASSERT_TRUE(fitted.ok());
  const std::vector<diagnose::Interval> intervals = diagnose::Intervals(fitted, PointersTo(runs), 1);
  ASSERT_EQ(intervals.size(), 1u);
  const double sample = runs[0].duration() / static_cast<double>(runs[0].samples() - 1);
  EXPECT_GT(intervals[0].high - intervals[0].low, 2 * 1.96 * 0.02 * sample);
  EXPECT_LT(intervals[0].high - intervals[0].low, 0.2 * sample);
}

// Tests that a small effect is never claimed more certain than the large terms beside it: a little more
// viscous friction than the model has is mistaken for drag.
TEST(Intervals, AllowForNumbersThatAreHeld) {
  constexpr double kDrag = 1e-5;
  model::ModelDescription truth = Table1With({{"pump.quadratic_drag", {{"k", kDrag}}, {}}});
  const model::ModelDescription held = truth;
  truth.parameters.b *= 1.001;
  const std::vector<diagnose::RunData> runs = ClampedPair(truth, 3, 1);
  const diagnose::Fitted fitted = diagnose::Fit(WithFree(held, {}), PointersTo(runs), StartsOf(runs), {});
  ASSERT_TRUE(fitted.ok());
  const double k = fitted.hypothesis.Free()[0].value;
  EXPECT_GT(k, 1.01 * kDrag);
  const std::vector<diagnose::Interval> intervals = diagnose::Intervals(fitted, PointersTo(runs), 1);
  ASSERT_EQ(intervals.size(), 1u);
  EXPECT_LE(intervals[0].low, kDrag);
  EXPECT_LT(intervals[0].high - intervals[0].low, k);
}

// Tests that no interval includes the impossible: friction that drives.
TEST(Intervals, StayWithinPhysics) {
  model::Parameters smooth = Table1();
  smooth.T_s = 0;
  const model::ModelDescription model{"smooth", smooth, {}};
  const std::vector<diagnose::RunData> runs = ClampedPair(model, 0.5, 1);
  const diagnose::Fitted fitted =
      diagnose::Fit(WithFree(model, {"T_s"}), PointersTo(runs), StartsOf(runs), {});
  ASSERT_TRUE(fitted.ok());
  const std::vector<diagnose::Interval> intervals = diagnose::Intervals(fitted, PointersTo(runs), 1);
  ASSERT_EQ(intervals.size(), 1u);
  EXPECT_EQ(intervals[0].low, 0);
  EXPECT_GT(intervals[0].high, 0);
}

// Tests that an interval is not cut off where the fit was not allowed to go.
TEST(Intervals, ReachBeyondTheFit) {
  const std::vector<diagnose::RunData> runs = ClampedPair(Table1With(), 0.5, 1);
  model::ModelDescription low = Table1With();
  low.parameters.T_s *= 0.4;
  diagnose::Hypothesis hypothesis = WithFree(low, {"T_s"});
  hypothesis.reach =
      std::make_shared<const diagnose::ValueReach>(diagnose::ReachOf(low.parameters, low.parameters));
  const diagnose::Fitted fitted = diagnose::Fit(hypothesis, PointersTo(runs), StartsOf(runs), {});
  ASSERT_TRUE(fitted.ok());
  const double most = 2 * low.parameters.T_s;
  EXPECT_NEAR(fitted.hypothesis.model.parameters.T_s, most, 1e-3 * most);
  EXPECT_GT(diagnose::Intervals(fitted, PointersTo(runs), 1).at(0).high, 1.005 * most);
}

// The given model with every base parameter free, held to what is known of it.
diagnose::Fitted FitAll(const model::ModelDescription& given, const std::vector<diagnose::RunData>& runs) {
  diagnose::Hypothesis hypothesis = WithFree(given, {});
  for (size_t i = 0; i < model::BaseParameters().size(); ++i) hypothesis.base.push_back(i);
  hypothesis.known = std::make_shared<diagnose::Knowledge>(diagnose::Knowledge{given, 1});
  return diagnose::Fit(hypothesis, PointersTo(runs), StartsOf(runs), {});
}

// Tests that a fit of all values at once finds those that are wrong, and leaves those of which the runs say
// nothing.
TEST(FitOfAllValues, LeavesWhatTheRunsDoNotTell) {
  model::ModelDescription given = Table1With();
  given.parameters.b *= 1.4;
  given.parameters.T_s *= 0.75;
  const std::vector<diagnose::RunData> runs = ClampedPair(Table1With(), 0.6, 1);
  const diagnose::Fitted fitted = FitAll(given, runs);
  ASSERT_TRUE(fitted.ok()) << fitted.failure;
  EXPECT_LT(fitted.squared_gap(), 1.1);
  const model::Parameters& found = fitted.hypothesis.model.parameters;
  const model::Parameters truth = Table1();
  EXPECT_NEAR(found.k_2, truth.k_2, 1e-6 * truth.k_2);  // the shaft is clamped
  EXPECT_NEAR(found.J_a, truth.J_a, 1e-6 * truth.J_a);
  EXPECT_NEAR(found.mgl, 0, 1e-3);
  // Equations (4), (13), (14) still hold when all torques and flows are multiplied by any number: what is
  // known settles it, and what is known best moves least.
  EXPECT_NEAR(found.D, truth.D, 0.02 * truth.D);
  EXPECT_NEAR(found.T_s, truth.T_s, 0.05 * truth.T_s);
  EXPECT_NEAR(found.b, truth.b, 0.1 * truth.b);
}

}  // namespace
}  // namespace hydro::testing
