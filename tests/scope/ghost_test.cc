#include "scope/signals/ghost.h"

#include <gtest/gtest.h>

#include <cmath>
#include <hydro/state_t.hpp>
#include <limits>
#include <random>

#include "base/input_error.h"
#include "scope/signals/decoded.h"
#include "tests/scope/recorded_run.h"

namespace hydro::scope {
namespace {

const std::vector<std::string> kQuiet = {
    "time.mode=lockstep",  "time.duration_s=3",
    "noise.p1=0",          "noise.p2=0",
    "noise.arm_angle=0",   "noise.arm_speed=0",
    "noise.motor_speed=0", "reference.steps=[[0.1, 0.1], [1, -0.1], [2, 0]]"};

std::vector<GhostSample> Samples(const settings::StackConfig& config) {
  std::vector<GhostSample> samples;
  for (const RecordedMessage& message : Record(config)) {
    if (message.channel != "HYDRO_STATE") continue;
    state_t state{};
    EXPECT_TRUE(Decoded(&state, message.data.data(), static_cast<int>(message.data.size())));
    samples.push_back(
        {state.time,
         state.voltage,
         {state.motor_angle, state.motor_speed, state.arm_angle, state.arm_speed, state.p1, state.p2},
         false});
  }
  return samples;
}

// The largest difference between the measured and the ghost's, of dp in psi.
double Worst(const settings::StackConfig& model, const std::vector<GhostSample>& samples, double resync_s) {
  Ghost ghost(std::make_shared<const settings::StackConfig>(model), resync_s);
  double worst = 0;
  for (const GhostSample& sample : samples) {
    const auto row = ghost.Add(sample);
    EXPECT_TRUE(row) << ghost.problem();
    if (!row) return NAN;
    const double dp = sample.measured.p2 - sample.measured.p1;
    worst = std::max(worst, std::abs(dp - (*row)[static_cast<size_t>(GhostColumn::kDp)]));
  }
  return worst;
}

// Tests that the ghost of the very model that was simulated stays on it to what integration leaves, with and
// without being set to it again. Pressures here are some 100 psi, and the tolerances 1e-8 and 1e-6 of that
// add up over slips and sticks.
TEST(GhostTest, FollowsItsOwnModel) {
  const auto config = DemoConfig(kQuiet);
  const auto samples = Samples(config);
  ASSERT_EQ(samples.size(), 3001u);
  EXPECT_LT(Worst(config, samples, 0), 0.05);
  EXPECT_LT(Worst(config, samples, 0.5), 0.05);
}

// Tests that a wrong friction shows: the gap is hundreds of times larger than with the right model, and
// smaller where the ghost is set to the measured state more often.
TEST(GhostTest, WrongFrictionShows) {
  const auto config = DemoConfig(kQuiet);
  const auto samples = Samples(config);
  auto wrong = config;
  wrong.model.description.parameters.T_s *= 2;
  const double apart = Worst(wrong, samples, 0.5);
  EXPECT_GT(apart, 1);
  EXPECT_GT(apart, 100 * Worst(config, samples, 0.5));
  EXPECT_LT(Worst(wrong, samples, 0.005), apart / 2);
}

// Tests that residuals are in units of the noise: with the right model and noise alone they are about 1.
TEST(GhostTest, ResidualsAreInUnitsOfTheNoise) {
  auto overrides = kQuiet;
  overrides[2] = "noise.p1=2";
  const auto config = DemoConfig(overrides);
  for (const bool stated : {true, false}) {
    auto known = config;
    if (!stated) known.noise.p1_psi = 0;  // then it is estimated
    // What it starts from has the noise too, so it is started once, from a sample without.
    auto samples = Samples(config);
    samples[0].measured.p1 = samples[0].measured.p2;
    Ghost ghost(std::make_shared<const settings::StackConfig>(known), 0);
    double sum = 0;
    int count = 0;
    for (const GhostSample& sample : samples) {
      const auto row = ghost.Add(sample);
      ASSERT_TRUE(row);
      const double residual = (*row)[static_cast<size_t>(GhostColumn::kResidualP1)];
      if (std::isnan(residual)) continue;
      sum += residual * residual;
      ++count;
    }
    EXPECT_GT(count, 2700);
    EXPECT_NEAR(std::sqrt(sum / count), 1, 0.1) << stated;  // a wrong unit would be off by a factor
  }
}

// Tests that after a gap it begins anew from the measured state, where residuals are missing.
TEST(GhostTest, BeginsAnewAfterAGap) {
  const auto config = DemoConfig(kQuiet);
  auto samples = Samples(config);
  Ghost ghost(std::make_shared<const settings::StackConfig>(config), 0);
  for (size_t k = 0; k < 1000; ++k) ghost.Add(samples[k]);
  EXPECT_EQ(ghost.starts(), 1);
  samples[1200].after_gap = true;
  const auto row = ghost.Add(samples[1200]);
  ASSERT_TRUE(row);
  EXPECT_EQ(ghost.starts(), 2);
  EXPECT_TRUE(std::isnan((*row)[static_cast<size_t>(GhostColumn::kResidualP1)]));
  EXPECT_EQ((*row)[static_cast<size_t>(GhostColumn::kP1)], samples[1200].measured.p1);
  ghost.Sync();
  ghost.Add(samples[1201]);
  EXPECT_EQ(ghost.starts(), 3);
}

// Tests that without measured speeds it begins from the angles' rates, and that without pressures it says why
// it does not.
TEST(GhostTest, BeginsFromWhatIsMeasured) {
  const auto config = DemoConfig(kQuiet);
  auto samples = Samples(config);
  Ghost by_angles(std::make_shared<const settings::StackConfig>(config), 0);
  for (size_t k = 500; k < 600; ++k) {
    samples[k].measured.motor_speed = samples[k].measured.arm_speed = NAN;
    by_angles.Add(samples[k]);
  }
  EXPECT_EQ(by_angles.starts(), 1);
  Ghost without(std::make_shared<const settings::StackConfig>(config), 0);
  for (size_t k = 700; k < 720; ++k) {
    samples[k].measured.p1 = NAN;
    EXPECT_FALSE(without.Add(samples[k]));
  }
  EXPECT_EQ(without.problem(), "a state that it begins from is not measured");
  EXPECT_THROW(Ghost(std::make_shared<const settings::StackConfig>(config), -1), InputError);
}

// Tests that a clamped shaft stays where it is.
TEST(GhostTest, FollowsAClampedShaft) {
  auto overrides = kQuiet;
  overrides.back() = "reference.steps=[[0.1, 20], [1, -20]]";
  overrides.insert(overrides.end(),
                   {"model.shaft=clamped", "model.arm_angle=0.2", "reference.signal=pressure"});
  const auto config = DemoConfig(overrides);
  EXPECT_LT(Worst(config, Samples(config), 0.5), 0.05);
}

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
