#include "tune/design/linear_stack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/runs/shipped_models.h"
#include "tune/design/arm_loop.h"
#include "tune/design/linear_loop.h"
#include "tune/design/loop_margins.h"
#include "tune/design/operating_cases.h"
#include "tune/design/sampled_position_loop.h"

namespace hydro::design {
namespace {

using experiments::ShippedModel;

// Figure 8's design model as if it were an actuator whose voltage is dp_ref and whose p2 is dp.
model::LinearModel AsActuator(const DesignModel& m) {
  model::LinearModel model;
  model.states = 4;  // dp, dp', alpha, alpha'
  model.inputs = 1;
  model.outputs = 6;
  const double squared = m.natural_frequency * m.natural_frequency;
  model.A.assign(16, 0);
  const auto set = [&](int row, int column, double value) { model.A[row + 4 * column] = value; };
  set(0, 1, 1);
  set(1, 0, -squared);
  set(1, 1, -2 * m.damping_ratio * m.natural_frequency);
  set(2, 3, 1);
  set(3, 0, m.k_2 / m.J_a);
  model.B = {0, squared, 0, 0};
  model.C.assign(24, 0);
  model.C[2 + 6 * 2] = 1;  // the arm's angle
  return model;
}

double Radius(const std::vector<Complex>& poles) {
  double radius = 0;
  for (const Complex& pole : poles) radius = std::max(radius, std::abs(pole));
  return radius;
}

const pressure_ctrl::PressureLawSettings kPassOn = {.gains = {}, .reference_feedforward = 1};

// Tests the position loop against the design model's own sampled loop, whose equations are written down
// separately, also when the pressure loop takes over the same reference many times a sample.
TEST(LinearStack, AgreesWithTheSampledDesignModel) {
  const DesignModel design = Figure8Model(ShippedModel("table1").parameters);
  for (const double interval : {0.001, 0.002, 0.005}) {
    for (const int ticks : {1, 25}) {
      const position_ctrl::PositionLawSettings law = {.c1 = 30 * 100, .c2 = 100, .sample_interval = interval};
      const StackTiming timing = {.tick = interval / ticks, .command_delay = 0, .position_interval = ticks};
      const LinearStack stack(AsActuator(design), timing, kPassOn, &law);
      EXPECT_NEAR(stack.period(), interval, 1e-15);
      EXPECT_NEAR(Radius(stack.Poles(1, 1)), SpectralRadius(design, 100, interval), 1e-9) << interval;
      const LoopMargins margins =
          MarginsOf([&](double factor) { return stack.Poles(1, factor); }, stack.period());
      EXPECT_NEAR(margins.gain * 100, SampledCriticalGain(design, interval), 1e-5) << interval;
    }
  }
}

// Tests patterns of samples that do not divide each other against the tick by tick product of one that does:
// sampling the pressure loop more often changes nothing where it only passes the reference on.
TEST(LinearStack, HandlesIntervalsThatDoNotDivideEachOther) {
  const DesignModel design = Figure8Model(ShippedModel("table1").parameters);
  const position_ctrl::PositionLawSettings law = {.c1 = 3000, .c2 = 100, .sample_interval = 0.006};
  const auto radius = [&](int pressure_interval, int position_interval, double tick) {
    const StackTiming timing = {.tick = tick,
                                .command_delay = 0,
                                .pressure_interval = pressure_interval,
                                .position_interval = position_interval};
    const LinearStack stack(AsActuator(design), timing, kPassOn, &law);
    return std::pow(Radius(stack.Poles(1, 1)), 0.006 / stack.period());
  };
  const double each_tick = radius(1, 6, 0.001);
  EXPECT_NEAR(radius(2, 6, 0.001), each_tick, 1e-9);
  EXPECT_NEAR(radius(3, 6, 0.001), each_tick, 1e-9);
  // 4 ticks do not divide 6: every second reference is taken over 2 ms late.
  const double late = radius(4, 6, 0.001);
  EXPECT_GT(late, each_tick);
  EXPECT_NEAR(radius(8, 12, 0.0005), late, 1e-9);
  const StackTiming seldom = {.tick = 1e-6, .pressure_interval = 4999, .position_interval = 6001};
  EXPECT_THROW(LinearStack(AsActuator(design), seldom, kPassOn, &law), std::domain_error);
}

settings::StackConfig Clamped() {
  settings::StackConfig config;
  config.model.description = ShippedModel("table1");
  config.model.shaft = model::Shaft::kClamped;
  return config;
}

// Tests the pressure loop's poles and its critical gain against LinearPressureLoop's, with and without delay.
TEST(LinearStack, AgreesWithThePressureLoop) {
  const auto cases = OperatingCases(Clamped());
  ASSERT_EQ(cases.size(), 3U);
  const pressure_ctrl::PressureGains gains =
      pressure_ctrl::DerivePressureGains(ShippedModel("table1").parameters, 0, 150, 0.5, 2);
  for (const OperatingCase& point : cases) {
    for (const int delay : {0, 1}) {
      const LinearPressureLoop other(point.model, {1e-3, delay});
      const LinearStack stack(point.model, {.tick = 1e-3, .command_delay = delay}, {.gains = gains}, nullptr);
      std::vector<Complex> poles;
      for (const Complex& z : stack.Poles(1, 0)) {
        if (std::abs(z) > 1e-12) poles.push_back(std::log(z) / 1e-3);
      }
      const auto order = [](Complex a, Complex b) {
        return a.real() != b.real() ? a.real() < b.real() : a.imag() > b.imag();
      };
      std::sort(poles.begin(), poles.end(), order);
      std::vector<Complex> expected = other.Poles(gains);
      ASSERT_EQ(poles.size(), expected.size());
      for (size_t i = 0; i < poles.size(); ++i) EXPECT_LT(std::abs(poles[i] - expected[i]), 1e-5) << i;
      const LoopMargins margins =
          MarginsOf([&](double factor) { return stack.Poles(factor, 0); }, stack.period());
      EXPECT_NEAR(margins.gain, LargestStableFactor(other, gains, 1000).factor, 1e-4 * margins.gain);
    }
  }
}

// Tests that the whole stack, sampled faster and faster, becomes the continuous loop with a free arm.
TEST(LinearStack, TendsToTheContinuousArmLoop) {
  settings::StackConfig config = Clamped();
  config.model.shaft = model::Shaft::kFree;
  config.limits.arm_angle_rad = 0.3;
  const OperatingCase middle = OperatingCases(config).front();
  pressure_ctrl::PressureLawSettings pressure;
  pressure.gains = pressure_ctrl::DerivePressureGains(ShippedModel("table1").parameters, 0, 150, 0.5, 2);
  pressure.arm_speed_ratio = 462.8;
  const LinearArmLoop continuous(ShippedModel("table1"), pressure);
  double before = 1e9;
  for (const double tick : {1e-3, 1e-4, 1e-5}) {
    const position_ctrl::PositionLawSettings position = {.c1 = 10000, .c2 = 900, .sample_interval = tick};
    const LinearStack stack(middle.model, {.tick = tick}, pressure, &position);
    double worst = 0;
    for (const Complex& expected : continuous.Poles(10000, 900)) {
      double nearest = 1e9;
      for (const Complex& z : stack.Poles(1, 1)) {
        nearest = std::min(nearest, std::abs(std::log(z) / tick - expected));
      }
      worst = std::max(worst, nearest / std::abs(expected));
    }
    EXPECT_LT(worst, 0.2 * before);
    before = worst;
  }
  EXPECT_LT(before, 0.002);
}

// Tests that a late amplifier and a late sensor cost the phase that their delay is, whole ticks or not: the
// delay margin falls by as much.
TEST(LinearStack, LateAmplifierAndSensorsTakeTheirDelayFromTheMargin) {
  const OperatingCase point = OperatingCases(Clamped()).front();
  const pressure_ctrl::PressureLawSettings law = {
      .gains = pressure_ctrl::DerivePressureGains(ShippedModel("table1").parameters, 0, 150, 0.5, 2)};
  const auto margin = [&](const StackTiming& timing) {
    const LinearStack stack(point.model, timing, law, nullptr);
    return MarginsOf([&](double factor) { return stack.Poles(factor, 0); }, stack.period()).delay;
  };
  const StackTiming timing = {.tick = 2e-4};
  const double plain = margin(timing);
  for (const double late : {5e-5, 2e-4, 3.3e-4, 1e-3}) {
    StackTiming amplifier = timing;
    amplifier.amplifier_delay = late;
    EXPECT_NEAR(plain - margin(amplifier), late, 1e-6) << late;
    StackTiming sensors = timing;
    sensors.late = late;
    sensors.late_outputs.fill(true);
    EXPECT_NEAR(plain - margin(sensors), late, 1e-6) << late;
    // Both at once.
    sensors.amplifier_delay = 1.3e-4;
    EXPECT_NEAR(plain - margin(sensors), late + 1.3e-4, 2e-6) << late;
  }
  StackTiming far = timing;
  far.amplifier_delay = 1;
  EXPECT_THROW(margin(far), std::domain_error);
}

}  // namespace
}  // namespace hydro::design
