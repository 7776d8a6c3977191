#include "diagnose/data/observed_mode.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "diagnose/data/run_start.h"
#include "model/terms/state.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::diagnose {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A run that measures only the motor's speed, at 1 kHz: `speed` plus noise of 0.3 rad/s.
template <class Speed>
RunData OfSpeed(size_t samples, const Speed& speed, double noise = 0.3) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  RunData run;
  SignalData signal;
  signal.channel = model::Channel::kMotorSpeed;
  signal.noise = noise;
  for (size_t k = 0; k < samples; ++k) {
    run.stimulus.time.push_back(1e-3 * static_cast<double>(k));
    run.stimulus.voltage.push_back(0);
    signal.values.push_back(speed(run.stimulus.time.back()) + noise * normal(random));
  }
  signal.valid = samples;
  run.signals.push_back(std::move(signal));
  return run;
}

// Tests that slip in either direction and rest are told apart, and that rest is not taken for a passage
// through zero.
TEST(ObservedMode, SlipAndRest) {
  const RunData run = OfSpeed(300, [](double t) { return t < 0.1 ? 20.0 : t < 0.2 ? 0.0 : -20.0; });
  const ObservedMode mode = ObserveMode(run);
  ASSERT_TRUE(mode.speed_measured());
  ASSERT_EQ(mode.turns.size(), 300u);
  EXPECT_EQ(mode.half_window, 2u);  // 2.5 ms on either side
  EXPECT_NEAR(mode.speed_margin, 3.5 * 0.3 / std::sqrt(5), 1e-12);
  for (size_t k = 10; k < 90; ++k) EXPECT_EQ(mode.turns[k], 1) << k;
  for (size_t k = 110; k < 190; ++k) EXPECT_EQ(mode.turns[k], 0) << k;
  for (size_t k = 210; k < 290; ++k) EXPECT_EQ(mode.turns[k], -1) << k;
  for (size_t k = 110; k < 190; ++k) EXPECT_EQ(mode.passes[k], 0) << k;
}

// Tests that a quick reversal is a passage through zero: friction may have either sign there, but nothing
// rests.
TEST(ObservedMode, ReversalWithoutRest) {
  const RunData run = OfSpeed(200, [](double t) { return 400 * (0.1 - t); });
  const ObservedMode mode = ObserveMode(run);
  size_t passes = 0;
  for (size_t k = 0; k < 200; ++k) {
    EXPECT_NE(mode.turns[k], 0) << k;
    passes += mode.passes[k];
  }
  EXPECT_GE(passes, 1u);
  EXPECT_LE(passes, 9u);
  EXPECT_EQ(mode.turns.front(), 1);
  EXPECT_EQ(mode.turns.back(), -1);
}

// Tests that missing speeds take the value before them and never come out as NaN.
TEST(ObservedMode, GapsAreFilled) {
  RunData run = OfSpeed(200, [](double) { return 30.0; });
  for (size_t k = 50; k < 80; ++k) run.signals[0].values[k] = kNan;
  for (size_t k = 0; k < 10; ++k) run.signals[0].values[k] = kNan;
  const ObservedMode mode = ObserveMode(run);
  for (size_t k = 0; k < 200; ++k) {
    EXPECT_NEAR(mode.motor_speed[k], 30, 2) << k;
    EXPECT_EQ(mode.turns[k], 1) << k;
  }
}

// Tests that a run without a speed or an angle says nothing about the pump, and that its pressures are still
// averaged.
TEST(ObservedMode, WithoutASpeed) {
  RunData run = OfSpeed(
      100, [](double) { return 200.0; }, 1.5);
  run.signals[0].channel = model::Channel::kP1;
  const ObservedMode mode = ObserveMode(run);
  EXPECT_FALSE(mode.speed_measured());
  ASSERT_EQ(mode.p1.size(), 100u);
  EXPECT_TRUE(mode.p2.empty());
  double square = 0;
  for (size_t k = 10; k < 90; ++k) square += std::pow(mode.p1[k] - 200, 2) / 80;
  EXPECT_LT(std::sqrt(square), 1.5 / 1.5) << "an average of five is quieter than one";
  EXPECT_NEAR(mode.p1_margin, 3.5 * 1.5 / std::sqrt(5), 1e-12);
}

// Tests that a run starts on the line through its first samples, to within their noise, not at the first
// sample.
TEST(RunStart, OnTheLineOfTheFirstSamples) {
  RunData moved = testing::SmallRun(testing::Table1With(), model::Shaft::kClamped, false, 0.5, 0, 3);
  const double p1 = moved.start[model::kP1];
  for (SignalData& signal : moved.signals) {
    if (signal.channel != model::Channel::kP2) continue;
    for (size_t k = 0; k < signal.values.size(); ++k) {
      signal.values[k] = 500 + 2000 * moved.stimulus.time[k] + (k % 2 == 0 ? 0.1 : -0.1);
    }
  }
  SetStart(testing::Table1(), &moved);
  EXPECT_NEAR(moved.start[model::kP2], 500, 0.2);
  EXPECT_EQ(moved.start[model::kP1], p1);
  EXPECT_TRUE(moved.start_free[model::kP1]);
  EXPECT_TRUE(moved.start_free[model::kP2]);
  EXPECT_EQ(moved.start[model::kArmAngle], 0.3);
  EXPECT_FALSE(moved.start_free[model::kArmAngle]) << "the shaft is clamped";
}

// Tests that with the bypass open both sides start at one pressure, a single unknown.
TEST(RunStart, OnePressureUnderBypass) {
  RunData run = testing::SmallRun(testing::Table1With(), model::Shaft::kClamped, true, 0.5, 3, 3);
  for (SignalData& signal : run.signals) {
    if (signal.channel == model::Channel::kP1) signal.values.assign(signal.values.size(), 90);
    if (signal.channel == model::Channel::kP2) signal.values.assign(signal.values.size(), 110);
  }
  SetStart(testing::Table1(), &run);
  EXPECT_DOUBLE_EQ(run.start[model::kP1], 100);
  EXPECT_DOUBLE_EQ(run.start[model::kP2], 100);
  EXPECT_TRUE(run.start_free[model::kP1]);
  EXPECT_FALSE(run.start_free[model::kP2]);
}

}  // namespace
}  // namespace hydro::diagnose
