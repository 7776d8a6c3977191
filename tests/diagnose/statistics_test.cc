// What the verdict rests on: intervals, significance, and what runs can tell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "diagnose/fit/comparison.h"
#include "diagnose/fit/intervals.h"
#include "diagnose/fit/prior.h"
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

// Tests that p-values are uniform where there is no effect: drops by chance are chi-squared times the
// residuals' worth.
TEST(PValue, IsUniformWithoutAnEffect) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (const size_t parameters : {1, 2, 3}) {
    constexpr int kDraws = 4000;
    std::vector<double> p_values;
    for (int i = 0; i < kDraws; ++i) {
      double fall = 0;
      for (size_t k = 0; k < parameters; ++k) fall += std::pow(normal(random), 2);
      p_values.push_back(diagnose::PValue(1.3 * 7 * fall, 1.3, 7, parameters, 1));
    }
    std::sort(p_values.begin(), p_values.end());
    double worst = 0;  // Kolmogorov-Smirnov
    for (int i = 0; i < kDraws; ++i)
      worst = std::max(worst, std::abs(p_values[static_cast<size_t>(i)] - (i + 0.5) / kDraws));
    EXPECT_LT(worst, 1.63 / std::sqrt(kDraws)) << parameters;  // 1 %
  }
}

// Tests how it allows for the number tried, and its limits.
TEST(PValue, AllowsForWhatWasTried) {
  EXPECT_NEAR(diagnose::PValue(3.841, 1, 1, 1, 1), 0.05, 1e-4);
  EXPECT_NEAR(diagnose::PValue(10.828, 1, 1, 1, 40), 0.04, 1e-4);
  EXPECT_EQ(diagnose::PValue(1, 1, 1, 1, 40), 1);
  EXPECT_EQ(diagnose::PValue(0, 1, 1, 1, 1), 1);
  EXPECT_EQ(diagnose::PValue(-5, 1, 1, 1, 1), 1);
  // A fit better than the noise is no reason to believe more.
  EXPECT_EQ(diagnose::PValue(5, 0.5, 1, 1, 1), diagnose::PValue(5, 1, 1, 1, 1));
}

// Tests the mean difference over its standard error.
TEST(TValue, IsTheMeanOverItsError) {
  const diagnose::BlockSums worse{{11, 22, 33}, 3}, better{{10, 20, 30}, 3};
  EXPECT_NEAR(TValue(worse, better), 2 / std::sqrt(1.0 / 3), 1e-12);
  EXPECT_NEAR(TValue(better, worse), -2 / std::sqrt(1.0 / 3), 1e-12);
  EXPECT_EQ(TValue(worse, worse), 0);
}

diagnose::Fitted AtTheTruth(const ExactPair& pair) {
  diagnose::Fitted fitted;
  fitted.hypothesis = WithFree(Table1With(), {});
  for (const diagnose::RunData& run : pair.runs) {
    fitted.runs.emplace_back();
    fitted.runs.back().start = ExactPair::Start(run);
  }
  return fitted;
}

// Tests that white-noise residuals count one each, and those that keep the fraction phi (1 + phi)/(1 - phi).
TEST(CorrelationOf, CountsWhatIsIndependent) {
  const ExactPair pair(2);
  for (const double phi : {0.0, 0.5, 0.8}) {
    const std::vector<diagnose::RunData> runs = pair.With(phi, 3);
    const double expected = (1 + phi) / (1 - phi);
    EXPECT_NEAR(CorrelationOf(PointersTo(runs), AtTheTruth(pair)), expected, 0.25 * expected) << phi;
  }
}

// Tests that blocks add up to the whole, in the order of time.
TEST(BlocksOf, AddUpToTheWhole) {
  const ExactPair pair(0.5);
  const std::vector<diagnose::RunData> runs = pair.With(0, 1);
  diagnose::HeldOut predicted;
  for (const diagnose::RunData& run : runs) {
    predicted.starts.push_back(ExactPair::Start(run));
    predicted.models.push_back(Table1With());
  }
  const diagnose::BlockSums blocks = diagnose::BlocksOf(PointersTo(runs), predicted);
  double sum = 0;
  for (const double block : blocks.sums) sum += block;
  EXPECT_EQ(blocks.count, 2 * 3 * 500);
  EXPECT_NEAR(sum, blocks.count, 0.1 * blocks.count);
  predicted.models[1].parameters.k_1 *= 1.1;
  const diagnose::BlockSums worse = diagnose::BlocksOf(PointersTo(runs), predicted);
  for (size_t i = 0; i < blocks.sums.size() / 2; ++i) EXPECT_EQ(worse.sums[i], blocks.sums[i]);
  EXPECT_GT(TValue(worse, blocks), 2);
}

// The given model with every base parameter free, held to what is known of it.
diagnose::Fitted FitAll(const model::ModelDescription& given, const std::vector<diagnose::RunData>& runs) {
  diagnose::Hypothesis hypothesis = WithFree(given, {});
  for (size_t i = 0; i < model::BaseParameters().size(); ++i) hypothesis.base.push_back(i);
  hypothesis.known = std::make_shared<diagnose::Knowledge>(diagnose::Knowledge{given, 1});
  return diagnose::Fit(hypothesis, PointersTo(runs), StartsOf(runs), {});
}

// Tests that a fit of all values at once finds those that are wrong, and leaves those of which the runs say nothing.
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
  // Equations (4), (13), (14) still hold when all torques and flows are multiplied by any number: what is known
  // settles it, and what is known best moves least.
  EXPECT_NEAR(found.D, truth.D, 0.02 * truth.D);
  EXPECT_NEAR(found.T_s, truth.T_s, 0.05 * truth.T_s);
  EXPECT_NEAR(found.b, truth.b, 0.1 * truth.b);
}

// Tests that a gap counts as closed near the noise, and by its share only where there is hardly any noise.
TEST(Closed, NearTheNoiseOrOfExactSensors) {
  EXPECT_TRUE(diagnose::Closed(200, 1.15 * 1.15 - 1e-9, false));
  EXPECT_FALSE(diagnose::Closed(200, 1.4, false));
  EXPECT_TRUE(diagnose::Closed(200, 1.4, true));
  EXPECT_FALSE(diagnose::Closed(200, 3.5, true));
  const std::vector<diagnose::RunData> noisy = ClampedPair(Table1With(), 0.3, 1);
  EXPECT_FALSE(ExactSensors(PointersTo(noisy)));
  NoisyRig exact;
  exact.model = Table1With();
  exact.pressure_noise = exact.speed_noise = 0;
  exact.encoder_bits = 26;
  std::vector<diagnose::RunData> runs;
  runs.push_back(
      exact.Record("exact", model::Shaft::kClamped, 0, 0.5, false, [](double t) { return Levels(t, 0); }));
  EXPECT_TRUE(ExactSensors(PointersTo(runs)));
}

// Tests how large a gain must be to count: a share of the whole and of what exceeds the noise.
TEST(Material, AsksForAGainThatMatters) {
  EXPECT_FALSE(diagnose::Material(1.02, 1.00));
  EXPECT_FALSE(diagnose::Material(1.0, 1.0 - 0.5 * diagnose::kLeastGain));
  EXPECT_TRUE(diagnose::Material(1 + 2 * diagnose::kLeastGain, 1.0));
  EXPECT_FALSE(diagnose::Material(101, 101 - 0.5 * diagnose::kLeastShare * 100));
  EXPECT_TRUE(diagnose::Material(101, 101 - 1.5 * diagnose::kLeastShare * 100));
  EXPECT_FALSE(diagnose::Material(2, 3));
  EXPECT_EQ(diagnose::LeastMaterialGain(1), diagnose::kLeastGain);
  EXPECT_EQ(diagnose::LeastMaterialGain(101), diagnose::kLeastShare * 100);
}

}  // namespace
}  // namespace hydro::testing
