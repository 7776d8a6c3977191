// Tests of measured runs on the balances' grid: derivatives, gaps, noise, and which of two signals of one
// quantity is believed.
#include "diagnose/balances/run_motion.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "diagnose/balances/rows_to_read.h"
#include "tests/diagnose/balances/clean_runs.h"
#include "tests/diagnose/prepare_run.h"

namespace hydro::testing {
namespace {

using diagnose::GridChannel;
using diagnose::RunMotion;

constexpr double kEvery = 1e-3;

const runs::MeasuredRun& PressedRun() {
  static const runs::MeasuredRun run = Measure(PlainMachine(), RichRuns()[0]);
  return run;
}

// The motion of a clamped run with something changed in the recording.
RunMotion MotionWith(const std::function<void(runs::MeasuredRun*)>& change,
                     const std::vector<std::string>& inverted = {}) {
  runs::MeasuredRun run = PressedRun();
  change(&run);
  const model::Parameters given = PlainMachine().parameters;
  return diagnose::MotionOf(diagnose::PrepareRun(std::move(run), given), given, {.inverted = inverted});
}

RunMotion PlainMotion() {
  return MotionWith([](runs::MeasuredRun*) {});
}

// Each value comes so many samples later.
void Delay(size_t samples, std::vector<double>* values) {
  std::vector<double> late(values->size(), values->front());
  for (size_t i = samples; i < late.size(); ++i) late[i] = (*values)[i - samples];
  *values = late;
}

// Tests that the derivative of a cubic is exact, and that of a straight line up to its ends.
TEST(RunMotion, DerivativeIsExactOnCubics) {
  std::vector<double> cubic, line;
  for (int k = 0; k < 40; ++k) {
    const double t = kEvery * k;
    cubic.push_back(2 + 3 * t - 40 * t * t + 500 * t * t * t);
    line.push_back(2 - 7 * t);
  }
  const std::vector<double> rate = diagnose::Derivative(cubic, kEvery),
                            slope = diagnose::Derivative(line, kEvery);
  for (size_t k = 3; k + 3 < cubic.size(); ++k) {
    const double t = kEvery * static_cast<double>(k);
    EXPECT_NEAR(rate[k], 3 - 80 * t + 1500 * t * t, 1e-9);
  }
  for (const double one : slope) EXPECT_NEAR(one, -7, 1e-9);
}

// Tests that smoothing keeps constants, and lines away from the ends, and that it takes a Gaussian's part of
// a wave.
TEST(RunMotion, SmoothingIsAGaussian) {
  constexpr double kSigma = 2, kFrequency = 0.4;  // samples, rad a sample
  std::vector<double> line, wave;
  for (int k = 0; k < 100; ++k) {
    line.push_back(1 + 0.5 * k);
    wave.push_back(std::sin(kFrequency * k));
  }
  const std::vector<double> constant = diagnose::Smoothed(std::vector<double>(100, 3.0), kSigma);
  for (const double one : constant) EXPECT_NEAR(one, 3, 1e-12);
  const std::vector<double> straight = diagnose::Smoothed(line, kSigma),
                            less = diagnose::Smoothed(wave, kSigma);
  const double part = std::exp(-0.5 * kSigma * kSigma * kFrequency * kFrequency);
  for (size_t k = 10; k < 90; ++k) {
    EXPECT_NEAR(straight[k], line[k], 1e-9);
    EXPECT_NEAR(less[k], part * wave[k], 1e-3);
  }
  EXPECT_DOUBLE_EQ(diagnose::SmoothingOf(1e-3), diagnose::kSmoothing);
  EXPECT_DOUBLE_EQ(diagnose::SmoothingOf(1e-2), 7e-3);
}

// Tests that the motion agrees with what was simulated, smoothed: its rates are those of its values.
TEST(RunMotion, RatesBelongToValues) {
  const RunMotion motion = PlainMotion();
  EXPECT_NEAR(motion.step, 5e-4, 1e-12);
  EXPECT_EQ(motion.stride, 4u);  // balances are needed each 2 ms
  EXPECT_TRUE(motion.pressures);
  EXPECT_FALSE(motion.arm_moves);
  ASSERT_EQ(motion.size(), PressedRun().time.size());
  double fastest = 0, apart = 0;
  for (size_t k = 200; k + 200 < motion.size(); k += 50) {
    const model::KnownMotion &before = motion.at[k - 1], &at = motion.at[k], &after = motion.at[k + 1];
    const double rate = (after.p1 - before.p1) / (2 * motion.step);
    fastest = std::max(fastest, std::abs(rate));
    apart = std::max(apart, std::abs(at.p1_rate - rate));
    EXPECT_NEAR((after.motor_angle - before.motor_angle) / (2 * motion.step), at.motor_speed, 1.0);
    EXPECT_EQ(at.voltage, PressedRun().voltage.values[k]);
    EXPECT_EQ(at.arm_angle, 0.1);
  }
  EXPECT_LT(apart, 0.02 * fastest);
}

// Tests that a speed that agrees with the angle is believed.
TEST(RunMotion, SpeedThatAgreesIsBelieved) {
  const RunMotion motion = PlainMotion();
  EXPECT_FALSE(motion.from_angle);
  EXPECT_TRUE(motion.speed_known);
}

// Tests that of a speed 1.14 times the angle's rate, the angle is believed.
TEST(RunMotion, SpeedInAnotherUnitIsNotBelieved) {
  const RunMotion motion = MotionWith([](runs::MeasuredRun* run) {
    for (double& value : run->motor_speed.values) value *= 1.14;
  });
  EXPECT_TRUE(motion.from_angle);
  const RunMotion plain = PlainMotion();
  double most = 0;
  for (size_t k = 100; k + 100 < plain.size(); ++k)
    most = std::max(most, std::abs(motion.at[k].motor_speed - plain.at[k].motor_speed));
  EXPECT_LT(most, 1.0);  // of some hundred rad/s
}

// Tests that of a speed that is recorded late, the angle is believed, unless less than filters do explains
// it.
TEST(RunMotion, LateSpeedIsNotBelieved) {
  const auto late = [](size_t samples) {
    return MotionWith([&](runs::MeasuredRun* run) { Delay(samples, &run->motor_speed.values); });
  };
  EXPECT_FALSE(late(1).from_angle);
  EXPECT_TRUE(late(10).from_angle);
  EXPECT_TRUE(late(40).from_angle);  // 20 ms
}

// Tests that a sensor's noise is that of most runs of its recorder, also in a run in which it mostly rests.
TEST(RunMotion, OneSensorHasOneNoise) {
  std::vector<diagnose::RunData> runs;
  const model::Parameters given = PlainMachine().parameters;
  for (int r = 0; r < 4; ++r) {
    runs::MeasuredRun run = PressedRun();
    run.motor_angle = {};
    run.motor_speed.noise.reset();
    std::mt19937_64 random(static_cast<uint64_t>(r));
    std::normal_distribution<double> normal;
    for (double& value : run.motor_speed.values) value += 0.5 * normal(random);
    if (r == 2) {  // stands but for a moment
      for (size_t k = 300; k < run.motor_speed.values.size(); ++k)
        run.motor_speed.values[k] = 1e-3 * static_cast<double>(k % 2);
    }
    runs.push_back(diagnose::PrepareRun(std::move(run), given));
  }
  const auto least = diagnose::LeastNoises(diagnose::PointersTo(runs));
  const auto speed = static_cast<size_t>(GridChannel::kSpeed);
  EXPECT_EQ(least[0][speed], 0);
  EXPECT_NEAR(least[2][speed], 0.5, 0.05);
  const RunMotion alone = diagnose::MotionOf(runs[2], given),
                  among = diagnose::MotionOf(runs[2], given, {.least_noise = least[2]});
  EXPECT_LT(alone.speed_noise, 0.1 * among.speed_noise);
}

// Tests that long recordings are read in part: every n-th sample, down to 2 ms, and of what is still more the
// part in which most happens.
TEST(RunMotion, LongRecordingsAreReadInPart) {
  const model::Parameters given = PlainMachine().parameters;
  runs::MeasuredRun run = PressedRun();
  const diagnose::RunData data = diagnose::PrepareRun(run, given);
  const std::vector<const diagnose::RunData*> one = {&data};
  EXPECT_EQ(diagnose::RowsToRead(one).every, 1u);
  EXPECT_EQ(diagnose::RowsToRead(one).part, 1);
  const size_t often = 2 * 80000 / data.samples();
  const diagnose::RowsRead twice = diagnose::RowsToRead(std::vector<const diagnose::RunData*>(often, &data));
  EXPECT_EQ(twice.every, 2u);
  EXPECT_NEAR(twice.part, 1, 0.06);
  const diagnose::RowsRead much =
      diagnose::RowsToRead(std::vector<const diagnose::RunData*>(20 * often, &data));
  EXPECT_EQ(much.every, 4u);  // of 0.5 ms
  EXPECT_NEAR(much.part, 0.1, 0.01);

  const RunMotion whole = diagnose::MotionOf(data, given),
                  half = diagnose::MotionOf(data, given, {.every = 2});
  EXPECT_DOUBLE_EQ(half.step, 2 * whole.step);
  EXPECT_EQ(half.interval, whole.interval);
  EXPECT_EQ(half.stride, whole.stride / 2);
  double lowest = whole.at[0].p1, highest = lowest;
  for (const model::KnownMotion& at : whole.at) {
    lowest = std::min(lowest, at.p1);
    highest = std::max(highest, at.p1);
  }
  for (size_t k = 50; k + 50 < half.size(); k += 50) {
    // Weighted by the rows' times, which are rounded.
    EXPECT_NEAR(half.at[k].voltage, 0.5 * (whole.at[2 * k].voltage + whole.at[2 * k + 1].voltage), 1e-9);
    EXPECT_NEAR(half.at[k].p1, whole.at[2 * k].p1, 0.02 * (highest - lowest));
  }

  RunMotion quiet = whole;
  for (size_t k = 0; k < quiet.size(); ++k) {
    if (k < quiet.size() / 2) quiet.at[k].voltage = quiet.at[k].motor_speed = 0;
  }
  const RunMotion busy = diagnose::BusiestPart(quiet, 0.25);
  EXPECT_NEAR(static_cast<double>(busy.size()), 0.25 * static_cast<double>(quiet.size()), 1);
  EXPECT_GE(busy.at.front().time, quiet.at[quiet.size() / 2 - 1].time);
  EXPECT_EQ(busy.voltage.size(), busy.size());
}

// Tests that without a speed the angle's rate is it, and without both no speed is known.
TEST(RunMotion, SpeedOfTheAngle) {
  const RunMotion angle = MotionWith([](runs::MeasuredRun* run) { run->motor_speed = {}; });
  EXPECT_TRUE(angle.from_angle);
  EXPECT_TRUE(angle.speed_known);
  const RunMotion neither =
      MotionWith([](runs::MeasuredRun* run) { run->motor_speed = run->motor_angle = {}; });
  EXPECT_FALSE(neither.speed_known);
  EXPECT_FALSE(neither.from_angle);
}

// Tests that missing samples are bridged and marked, and others are not.
TEST(RunMotion, GapIsMarked) {
  const RunMotion motion = MotionWith([](runs::MeasuredRun* run) {
    for (size_t k = 1000; k < 1100; ++k) run->p1.values[k] = std::numeric_limits<double>::quiet_NaN();
  });
  const diagnose::GridSignal& p1 = motion.Of(GridChannel::kP1);
  ASSERT_EQ(p1.gap.size(), motion.size());
  for (size_t k = 0; k < motion.size(); ++k) {
    EXPECT_TRUE(std::isfinite(p1.values[k]));
    if (k > 1001 && k < 1099) {
      EXPECT_EQ(p1.gap[k], 1) << k;
    }
    if (k < 998 || k > 1102) {
      EXPECT_EQ(p1.gap[k], 0) << k;
    }
  }
  const std::vector<uint8_t>& other = motion.Of(GridChannel::kP2).gap;
  EXPECT_EQ(std::count(other.begin(), other.end(), 1), 0);
}

// Tests that a sensor whose readings have the wrong sign is turned round.
TEST(RunMotion, InvertedSensorIsTurnedRound) {
  const RunMotion plain = PlainMotion();
  const RunMotion turned = MotionWith(
      [](runs::MeasuredRun* run) {
        for (double& value : run->p2.values) value = -value;
      },
      {"p2"});
  for (size_t k = 0; k < plain.size(); k += 100) {
    EXPECT_DOUBLE_EQ(turned.at[k].p2, plain.at[k].p2);
    EXPECT_DOUBLE_EQ(turned.at[k].p1, plain.at[k].p1);
  }
}

// Tests that noise that is added once more is as large as the sensor's, and the same for the same seed.
TEST(RunMotion, NoiseAgain) {
  const model::Parameters given = PlainMachine().parameters;
  const RunMotion plain = PlainMotion();
  const RunMotion noisy = WithNoiseAgain(plain, given, 5), same = WithNoiseAgain(plain, given, 5);
  const std::vector<double>&a = plain.Of(GridChannel::kP1).values, &b = noisy.Of(GridChannel::kP1).values;
  double square = 0;
  for (size_t k = 0; k < a.size(); ++k) square += (b[k] - a[k]) * (b[k] - a[k]);
  // Of 4000 numbers, and between samples the mean of two: within a tenth.
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(a.size())), 1e-2, 1e-3);
  EXPECT_EQ(b, same.Of(GridChannel::kP1).values);
  EXPECT_NE(b, WithNoiseAgain(plain, given, 6).Of(GridChannel::kP1).values);
}

// Tests that what a sensor reads too much is taken off its signal and its rate, and off no other.
TEST(RunMotion, WithoutErrors) {
  const RunMotion plain = PlainMotion();
  diagnose::SignalErrors errors;
  std::vector<double>& p1 = errors.of[static_cast<size_t>(GridChannel::kP1)];
  for (size_t k = 0; k < plain.size(); ++k) p1.push_back(10 + 4 * plain.step * static_cast<double>(k));
  const RunMotion less = Without(plain, errors, 0.5);
  for (size_t k = 0; k < plain.size(); k += 100) {
    EXPECT_NEAR(less.at[k].p1, plain.at[k].p1 - 0.5 * p1[k], 1e-9);
    EXPECT_NEAR(less.at[k].p1_rate, plain.at[k].p1_rate - 2, 1e-6);
    EXPECT_EQ(less.at[k].p2, plain.at[k].p2);
    EXPECT_EQ(less.at[k].motor_speed, plain.at[k].motor_speed);
  }
}

}  // namespace
}  // namespace hydro::testing
