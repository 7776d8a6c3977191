#include "scope/signals/noise_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace hydro::scope {
namespace {

// Tests that noise on a motion is found to a tenth: 2048 second differences leave some 3 %, and neither steps
// nor spikes count.
TEST(NoiseEstimateTest, FindsTheNoiseOnAMotion) {
  NoiseEstimate estimate;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.5);
  for (int i = 0; i < 5000; ++i) {
    const double step = i > 2000 ? 100 : 0;
    const double spike = i % 500 == 0 ? 1000 : 0;
    estimate.Add(30 * std::sin(i * 0.001 * 2 * 3.14159) + step + spike + noise(random));
  }
  EXPECT_NEAR(estimate.sigma(), 0.5, 0.05);
}

// Tests that it says nothing before it has enough, nor of a signal without noise, and that a gap does not
// count.
TEST(NoiseEstimateTest, SaysNothingWithoutNoise) {
  NoiseEstimate estimate;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.5);
  for (size_t i = 0; i < NoiseEstimate::kFirst; ++i) estimate.Add(noise(random));
  EXPECT_TRUE(std::isnan(estimate.sigma()));
  estimate.Add(std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < 5; ++i) estimate.Add(noise(random));
  EXPECT_NEAR(estimate.sigma(), 0.5, 0.15);
  NoiseEstimate constant;
  for (int i = 0; i < 5000; ++i) constant.Add(3);
  EXPECT_TRUE(std::isnan(constant.sigma()));
}

}  // namespace
}  // namespace hydro::scope
