#include "tune/design/loop_margins.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tune/design/position_design.h"

namespace hydro::design {
namespace {

constexpr double kPeriod = 0.01;

// An integrator behind a delay of one sample: x(k+1) = x(k) - gain x(k-1). Its poles solve z^2 - z + gain =
// 0.
std::vector<Complex> DelayedIntegrator(double gain) {
  const Complex root = std::sqrt(Complex(0.25 - gain));
  return {0.5 + root, 0.5 - root};
}

// Tests the margins against their closed forms: |z| = 1 at a gain of 1 and 60 degrees a sample; below it
// |L| = gain/(2 sin(w/2)) and arg L = -90 deg - 1.5 w.
TEST(LoopMargins, OfADelayedIntegrator) {
  const double gain = 0.25;
  const LoopMargins m = MarginsOf([&](double factor) { return DelayedIntegrator(factor * gain); }, kPeriod);
  EXPECT_TRUE(m.stable);
  EXPECT_NEAR(m.spectral_radius, 0.5, 1e-7);
  EXPECT_NEAR(m.gain, 1 / gain, 1e-9);
  EXPECT_NEAR(m.gain_hz, 1 / (6 * kPeriod), 1e-9);
  EXPECT_EQ(m.least_gain, 0);
  const double crossover = 2 * std::asin(gain / 2);
  EXPECT_NEAR(m.phase_deg, 90 - 1.5 * crossover * 180 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(m.phase_hz, crossover / (2 * std::numbers::pi * kPeriod), 1e-9);
  EXPECT_NEAR(m.delay, (std::numbers::pi / 2 - 1.5 * crossover) / crossover * kPeriod, 1e-9);
  EXPECT_LT(m.distance, 1);
  EXPECT_GT(m.distance, 0.5);
}

// Tests that an unstable loop says how much less gain would be stable.
TEST(LoopMargins, OfAnUnstableLoop) {
  const LoopMargins m = MarginsOf([&](double factor) { return DelayedIntegrator(factor * 4); }, kPeriod);
  EXPECT_FALSE(m.stable);
  EXPECT_NEAR(m.gain, 0.25, 1e-9);
  EXPECT_EQ(m.phase_deg, 0);
  EXPECT_EQ(m.delay, 0);
  EXPECT_EQ(m.distance, 0);
}

// Tests a plant that is unstable alone, x(k+1) = 1.1 x(k) - gain x(k): gains from 0.1 to 2.1 hold it.
TEST(LoopMargins, HaveALowerLimitWhereThePlantIsUnstable) {
  const auto poles = [](double factor) { return std::vector<Complex>{1.1 - factor * 0.5}; };
  const LoopMargins m = MarginsOf(poles, kPeriod);
  EXPECT_TRUE(m.stable);
  EXPECT_NEAR(m.least_gain, 0.2, 1e-9);
  EXPECT_NEAR(m.gain, 4.2, 1e-9);
  EXPECT_NEAR(m.gain_hz, 0.5 / kPeriod, 1e-9);
}

// Tests that poles which the loop does not move count for stability only.
TEST(LoopMargins, LeaveOutWhatTheLoopDoesNotMove) {
  const auto with = [&](const Complex& other) {
    return MarginsOf(
        [other](double factor) {
          std::vector<Complex> poles = DelayedIntegrator(factor * 0.25);
          poles.push_back(other);
          poles.push_back(std::conj(other));
          return poles;
        },
        kPeriod);
  };
  const LoopMargins plain = MarginsOf([](double f) { return DelayedIntegrator(0.25 * f); }, kPeriod);
  const LoopMargins ringing = with(std::polar(0.999, 1.0));
  EXPECT_TRUE(ringing.stable);
  EXPECT_EQ(ringing.gain, plain.gain);
  EXPECT_EQ(ringing.damping_ratio, plain.damping_ratio);
  EXPECT_FALSE(with(std::polar(1.01, 1.0)).stable);
}

// Tests the damping ratio of a pair of poles against the s plane.
TEST(LoopMargins, Damping) {
  const Complex s = 40.0 * Complex(-0.3, std::sqrt(1 - 0.09));
  const Complex z = std::exp(s * kPeriod);
  const auto poles = [&](double factor) {
    return factor == 0 ? std::vector<Complex>{0.2, 0.3} : std::vector<Complex>{z, std::conj(z)};
  };
  EXPECT_NEAR(MarginsOf(poles, kPeriod).damping_ratio, 0.3, 1e-12);
}

// Tests the bandwidth against |T| of the delayed integrator, T = gain/(z^2 - z + gain), behind a filter.
TEST(LoopMargins, Bandwidth) {
  const auto poles = [](double factor) { return DelayedIntegrator(factor * 0.25); };
  const Filter filter = [](const Complex& z) { return 0.5 / (z - 0.5); };
  const LoopMargins m = MarginsOf(poles, kPeriod, Drift::kCounts, filter);
  const Complex z = std::polar(1.0, 2 * std::numbers::pi * kPeriod * m.bandwidth_hz);
  EXPECT_NEAR(std::norm(filter(z) * 0.25 / (z * z - z + 0.25)), 0.5, 1e-6);
  EXPECT_GT(m.bandwidth_hz, 1);
  EXPECT_EQ(MarginsOf(poles, kPeriod).bandwidth_hz, 0);
}

// Tests that a drift is ignored where it is somebody else's, and that what oscillates is not.
TEST(LoopMargins, DriftMayBeIgnored) {
  const auto poles = [](double factor) {
    std::vector<Complex> all = DelayedIntegrator(factor * 0.25);
    all.emplace_back(1 + 0.001 * factor);
    return all;
  };
  EXPECT_FALSE(MarginsOf(poles, kPeriod).stable);
  const LoopMargins m = MarginsOf(poles, kPeriod, Drift::kIgnored);
  EXPECT_TRUE(m.stable);
  EXPECT_NEAR(m.gain, 4, 0.1);
  // A swing that grows within hundreds of the loop's own times is one too; a faster one, or a faster growth,
  // is not.
  const auto swinging = [](double radius, double angle) {
    return [=](double factor) {
      std::vector<Complex> all = DelayedIntegrator(factor * 0.25);
      for (const double sign : {-1, 1}) all.push_back(std::polar(1 + factor * (radius - 1), sign * angle));
      return all;
    };
  };
  const LoopMargins swings = MarginsOf(swinging(1.001, 0.005), kPeriod, Drift::kIgnored);
  EXPECT_TRUE(swings.stable);
  EXPECT_NEAR(swings.gain, 4, 0.1);
  EXPECT_GT(swings.damping_ratio, 0);
  EXPECT_FALSE(MarginsOf(swinging(1.001, 0.005), kPeriod).stable);
  EXPECT_FALSE(MarginsOf(swinging(1.001, 0.1), kPeriod, Drift::kIgnored).stable);
  EXPECT_FALSE(MarginsOf(swinging(1.1, 0.005), kPeriod, Drift::kIgnored).stable);
  const auto oscillating = [](double factor) { return DelayedIntegrator(factor * 2); };
  EXPECT_FALSE(MarginsOf(oscillating, kPeriod, Drift::kIgnored).stable);
}

TEST(LoopMargins, WorstIsTakenNumberByNumber) {
  LoopMargins a;
  a.stable = true;
  a.gain = 2;
  a.gain_hz = 7;
  a.phase_deg = 50;
  LoopMargins b;
  b.stable = false;
  b.gain = 3;
  b.phase_deg = 20;
  b.phase_hz = 9;
  const LoopMargins worst = WorstOf(a, b);
  EXPECT_FALSE(worst.stable);
  EXPECT_EQ(worst.gain, 2);
  EXPECT_EQ(worst.gain_hz, 7);
  EXPECT_EQ(worst.phase_deg, 20);
  EXPECT_EQ(worst.phase_hz, 9);
}

}  // namespace
}  // namespace hydro::design
