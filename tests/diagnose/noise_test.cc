#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <random>

#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {
namespace {

constexpr size_t kSamples = 2000;
constexpr double kPi = std::numbers::pi;

// The mean estimate over five seeds for signal(t) with white noise, at `rate` samples a second; each single
// estimate must be near it.
double MeanEstimate(
    double rate, double noise, const std::function<double(double)>& signal,
    const std::function<void(std::vector<double>&)>& spoil = [](std::vector<double>&) {}) {
  double sum = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, noise);
    std::vector<double> values;
    for (size_t i = 0; i < kSamples; ++i) {
      values.push_back(signal(static_cast<double>(i) / rate) + normal(random));
    }
    spoil(values);
    const double estimate = EstimateNoise(values);
    EXPECT_NEAR(estimate, noise, 0.12 * noise) << "seed " << seed;
    sum += estimate / 5;
  }
  return sum;
}

// A pressure in a run: large and smooth, with an occasional jump.
double Motion(double t, double period) {
  const double phase = t / period - std::floor(t / period);
  return 900 * std::sin(2 * kPi * t / period) + (phase < 0.5 ? 200 : -200) +
         (phase > 0.5 ? 300 * std::exp(-(phase - 0.5) * 40) : 0);
}

// Tests that white noise is found alone, and under motion and jumps 600 times as large, at 1 kHz.
TEST(EstimateNoise, OnMotionWithJumps) {
  EXPECT_NEAR(MeanEstimate(1000, 1.5, [](double) { return 100.0; }), 1.5, 0.05 * 1.5);
  EXPECT_NEAR(MeanEstimate(1000, 1.5, [](double t) { return Motion(t, 0.5); }), 1.5, 0.05 * 1.5);
}

// Tests the same at 50 Hz, where the same motion fills far more of the spectrum.
TEST(EstimateNoise, OnMotionSampledSlowly) {
  EXPECT_NEAR(MeanEstimate(50, 1.5, [](double t) { return Motion(t, 8); }), 1.5, 0.05 * 1.5);
}

// Tests the same of a motor that is switched twice a second and seen at 100 and 200 Hz: each stretch of the
// spectrum has a corner in it.
TEST(EstimateNoise, OnCornersInEveryStretch) {
  const auto saw = [](double t) {
    const double phase = t / 0.47 - std::floor(t / 0.47);
    return 480 * std::abs(phase - 0.5) + 3 * phase * phase;
  };
  EXPECT_NEAR(MeanEstimate(100, 0.1, saw), 0.1, 0.1 * 0.1);
  EXPECT_NEAR(MeanEstimate(200, 0.1, saw), 0.1, 0.1 * 0.1);
}

// Tests that a signal that stands in every second or fourth row, or in rows of its own, has the noise of its
// own samples.
TEST(EstimateNoise, OfASignalInFewRows) {
  for (const size_t every : {2, 3, 4}) {
    std::mt19937_64 random(every);
    std::normal_distribution<double> normal(0, 0.1);
    std::vector<double> values(every * kSamples, std::numeric_limits<double>::quiet_NaN());
    for (size_t i = 0; i < kSamples; ++i)
      values[every * i] = 20 * std::sin(0.03 * static_cast<double>(i)) + normal(random);
    EXPECT_NEAR(EstimateNoise(values), 0.1, 0.01) << "in every " << every << "th row";
  }
}

// Tests that an angle that grows to a million times the noise does not leak into it.
TEST(EstimateNoise, OnGrowingAngle) {
  EXPECT_NEAR(MeanEstimate(1000, 1e-3, [](double t) { return 300 * t + 50 * std::sin(2 * kPi * 3 * t); }),
              1e-3, 0.05 * 1e-3);
}

// Tests that a ripple of one frequency in the upper spectrum, ten times the noise, does not count as noise.
TEST(EstimateNoise, RippleIsNoNoise) {
  EXPECT_NEAR(MeanEstimate(1000, 1.5, [](double t) { return 15 * std::sin(2 * kPi * 330.5 * t); }), 1.5,
              0.05 * 1.5);
}

// Tests that missing values, single and in stretches, change nothing.
TEST(EstimateNoise, MissingValues) {
  const auto spoil = [](std::vector<double>& values) {
    for (size_t i = 0; i < values.size(); i += 7) values[i] = std::numeric_limits<double>::quiet_NaN();
    for (size_t i = 400; i < 600; ++i) values[i] = std::numeric_limits<double>::quiet_NaN();
    values.front() = values.back() = std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_NEAR(MeanEstimate(
                  1000, 1.5, [](double t) { return Motion(t, 1); }, spoil),
              1.5, 0.06 * 1.5);
}

// Tests that noise is told from rounding: rounding alone is q/sqrt(12) however slowly the signal moves, and
// adds to noise larger than it.
TEST(EstimateNoise, Rounding) {
  const double q = 2 * kPi / 16384;
  std::vector<double> slow;
  for (size_t i = 0; i < kSamples; ++i) {
    slow.push_back(q * std::round(0.1 * std::sin(static_cast<double>(i) * 2 * kPi / kSamples) / q));
  }
  EXPECT_DOUBLE_EQ(EstimateNoise(slow), EstimateResolution(slow) / std::sqrt(12.0));
  EXPECT_NEAR(EstimateResolution(slow), q, 1e-9 * q);

  const auto round = [](std::vector<double>& values) {
    for (double& value : values) value = 0.5 * std::round(value / 0.5);
  };
  EXPECT_NEAR(MeanEstimate(
                  1000, 1.5, [](double t) { return Motion(t, 1); }, round),
              std::hypot(1.5, 0.5 / std::sqrt(12.0)), 0.05 * 1.5);
}

// Tests that a resolution is found through scaling and an offset, and none where there is none.
TEST(EstimateResolution, StepsAndNone) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 30);
  std::vector<double> fine, coarse;
  for (size_t i = 0; i < kSamples; ++i) {
    fine.push_back(normal(random));
    coarse.push_back(14.7 + 0.1047197 * std::round(fine.back()));
  }
  coarse[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(EstimateResolution(fine), 0);
  EXPECT_NEAR(EstimateResolution(coarse), 0.1047197, 1e-6);
  EXPECT_EQ(EstimateResolution(std::vector<double>(100, 3.5)), 0);
  EXPECT_EQ(EstimateResolution({}), 0);
}

// Tests that an encoder's steps are found whatever its shaft does: at rest, slowly or fast, at a speed of
// which no two counts are neighbours, back and forth, and behind the digits of a table; and that the noise is
// theirs.
TEST(EstimateResolution, OfAnEncoder) {
  const double q = 2 * kPi / 4096;
  const std::function<double(double)> motions[] = {[](double t) { return 0.3 * std::sin(0.01 * t); },
                                                   [](double t) { return 0.3 * t; },
                                                   [](double t) { return 2.3 * t; },
                                                   [](double t) { return 2.5 * t + 1e-4 * t * t; },
                                                   [](double t) { return 4000 * std::sin(t / 200); },
                                                   [](double t) { return 70000 * std::sin(t / 900); }};
  for (size_t which = 0; which < std::size(motions); ++which) {
    std::vector<double> values;
    for (size_t i = 0; i < 3 * kSamples; ++i)
      values.push_back(std::round(1e6 * q * std::floor(motions[which](static_cast<double>(i)))) / 1e6);
    EXPECT_NEAR(EstimateResolution(values), q, 1e-3 * q) << "motion " << which;
    EXPECT_NEAR(EstimateNoise(values), q / std::sqrt(12.0), 0.1 * q) << "motion " << which;
  }
}

// Tests that how far a steady motion gets in a row is no sensor's step.
TEST(EstimateResolution, NotOfASteadyMotion) {
  std::vector<double> values;
  for (size_t i = 0; i < kSamples; ++i) values.push_back(0.37 * static_cast<double>(i));
  EXPECT_EQ(EstimateResolution(values), 0);
}

// Tests that series too short for a spectrum, and empty ones, have no noise but rounding.
TEST(EstimateNoise, TooShort) {
  EXPECT_EQ(EstimateNoise({}), 0);
  EXPECT_EQ(EstimateNoise(std::vector<double>(200, std::numeric_limits<double>::quiet_NaN())), 0);
  EXPECT_DOUBLE_EQ(EstimateNoise({0, 1, 0, 1, 2}), 1 / std::sqrt(12.0));
}

}  // namespace
}  // namespace hydro::diagnose
