#include <gtest/gtest.h>

#include <cmath>

#include "plant/simulated_rig.h"

namespace hydro::plant {
namespace {

// Tests that the noise is standard normal: mean, variance, and the share beyond one and two standard
// deviations.
TEST(SensorNoiseTest, IsStandardNormal) {
  const int n = 200000;
  double sum = 0, squares = 0;
  int beyond_one = 0, beyond_two = 0;
  for (int tick = 0; tick < n; ++tick) {
    const double x = StandardNormal(1, tick, 0);
    sum += x;
    squares += x * x;
    beyond_one += std::fabs(x) > 1;
    beyond_two += std::fabs(x) > 2;
  }
  // Five standard errors each.
  EXPECT_NEAR(sum / n, 0, 5 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1, 5 * std::sqrt(2.0 / n));
  EXPECT_NEAR(beyond_one / double(n), 0.3173, 5 * std::sqrt(0.3173 * 0.6827 / n));
  EXPECT_NEAR(beyond_two / double(n), 0.0455, 5 * std::sqrt(0.0455 * 0.9545 / n));
}

// Tests that ticks, signals and seeds are uncorrelated.
TEST(SensorNoiseTest, IsUncorrelated) {
  const int n = 100000;
  double ticks = 0, channels = 0, seeds = 0;
  for (int tick = 0; tick < n; ++tick) {
    const double x = StandardNormal(1, tick, 0);
    ticks += x * StandardNormal(1, tick + 1, 0);
    channels += x * StandardNormal(1, tick, 1);
    seeds += x * StandardNormal(2, tick, 0);
  }
  const double five_sigma = 5 / std::sqrt(n);
  EXPECT_NEAR(ticks / n, 0, five_sigma);
  EXPECT_NEAR(channels / n, 0, five_sigma);
  EXPECT_NEAR(seeds / n, 0, five_sigma);
}

// Tests that noise depends only on seed, tick and signal, has the requested size and leaves the rest alone.
TEST(SensorNoiseTest, ScalesAndLeavesTheRestAlone) {
  model::Measurement truth;
  truth.p1 = 100;
  truth.p2 = 200;
  settings::NoiseSection noise;
  noise.p2_psi = 3;
  const model::Measurement a = ReadSensors(truth, noise, 7, 42);
  const model::Measurement b = ReadSensors(truth, noise, 7, 42);
  EXPECT_EQ(a.p2, b.p2);
  EXPECT_DOUBLE_EQ(a.p2, 200 + 3 * StandardNormal(7, 42, 1));
  EXPECT_EQ(a.p1, 100);
  EXPECT_EQ(a.motor_speed, 0);
  noise.p1_psi = 1;
  EXPECT_EQ(ReadSensors(truth, noise, 7, 42).p2, a.p2);  // another signal's noise changes nothing
}

// Tests that a resolution rounds the noisy reading to its nearest multiple, each signal by its own, and that
// rounding hides noise much smaller than the resolution.
TEST(SensorNoiseTest, RoundsToTheResolution) {
  model::Measurement truth;
  truth.p1 = 100.3;
  truth.p2 = 200.3;
  truth.motor_angle = -1.0;
  truth.arm_speed = 0.3;
  settings::NoiseSection noise;
  noise.p2_psi = 3;
  noise.p2_resolution_psi = 2000.0 / 4096;
  noise.motor_angle_resolution_rad = 2 * M_PI / 16384;
  noise.arm_speed_rad_s = 1e-6;
  noise.arm_speed_resolution_rad_s = 0.25;
  for (int tick = 0; tick < 100; ++tick) {
    const model::Measurement reading = ReadSensors(truth, noise, 7, tick);
    EXPECT_EQ(reading.p1, 100.3);
    const double noisy = 200.3 + 3 * StandardNormal(7, tick, 1);
    EXPECT_LE(std::fabs(reading.p2 - noisy), 0.5 * noise.p2_resolution_psi + 1e-9);
    const double counts = reading.p2 / noise.p2_resolution_psi;
    EXPECT_EQ(counts, std::round(counts));
    EXPECT_NEAR(reading.motor_angle, -2608 * noise.motor_angle_resolution_rad, 1e-12);  // 2607.6
    EXPECT_EQ(reading.arm_speed, 0.25);
  }
}

}  // namespace
}  // namespace hydro::plant
