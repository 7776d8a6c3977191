#include "tune/design/linear_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/runs/shipped_models.h"
#include "model/actuator.h"
#include "tests/tune/design/wave_polynomial.h"

namespace hydro::design {
namespace {

using experiments::ShippedModel;

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;

model::LinearModel Clamped(const model::ModelDescription& model, int valve_1_open) {
  const model::Equations equations(model, {.shaft = model::Shaft::kClamped});
  double state[model::kMaxStates];
  model::Mode mode;
  equations.Start(1000, state, &mode);
  mode.pump = 1;
  mode.valve_1 = static_cast<int8_t>(valve_1_open);
  return model::Linearise(equations, 0, 0, mode, state);
}

// Table 1 with waves in its lines.
model::ModelDescription WithWaves(double volume_fraction, double damping) {
  model::ModelDescription model = ShippedModel("table1");
  model.effects.push_back(
      {"line.wave", {{"frequency", 300}, {"volume_fraction", volume_fraction}, {"damping", damping}}, {}});
  return model;
}

pressure_ctrl::PressureGains PaperGains(int sides) {
  return pressure_ctrl::DerivePressureGains(ShippedModel("table1").parameters, 0, 150, 0.5, sides);
}

// With x = (dp, theta'): dp' = s theta' - a dp, J theta'' = k_1 v - D dp - b theta'. By hand from eqs. (4),
// (13), (14) at alpha = 0, leakage included.
struct HandModel {
  double s, a, J, b, D, k_1;
  explicit HandModel(int sides) {
    const model::Parameters p = ShippedModel("table1").parameters;
    s = sides * p.beta * p.D / p.V_ms;
    a = p.beta / p.V_ms * (p.c_E + sides * p.c_I);
    J = p.J, b = p.b, D = p.D, k_1 = p.k_1;
  }
  Complex Closed(const pressure_ctrl::PressureGains& g, Complex w) const {
    const double B = b + k_1 * g.k_p * g.k_v;
    return k_1 * g.k_p * s / ((J * w + B) * (w + a) + s * (D + k_1 * g.k_p));
  }
};

// Tests that the analog loop has the response and the poles of the hand-made second-order model, with one and
// with both sides compressing, and the paper's omega_n and zeta up to what leakage adds.
TEST(LinearPressureLoop, AnalogLoopIsSecondOrder) {
  for (const int sides : {1, 2}) {
    const HandModel hand(sides);
    const pressure_ctrl::PressureGains gains = PaperGains(sides);
    const LinearPressureLoop loop(Clamped(ShippedModel("table1"), sides == 1), {});
    for (double f = 0.1; f < 1000; f *= 1.7) {
      const Complex expected = hand.Closed(gains, Complex(0, 2 * kPi * f));
      EXPECT_LT(std::abs(loop.ClosedGain(gains, f) / expected - 1.0), 1e-9) << f;
    }
    const Complex pole = loop.LeastDampedPole(gains);
    EXPECT_LT(std::abs(1.0 / hand.Closed(gains, pole)), 1e-9);
    // Leakage is the sum of two rates near 1/s beside 2 zeta omega_n = 150/s.
    EXPECT_NEAR(std::abs(pole), 150, 0.6);
    EXPECT_NEAR(-pole.real() / std::abs(pole), 0.5, 0.005);
  }
}

// Tests the paper's two-sided gains on the plant of one side, omega_n 106.5 and zeta .707: omega_n^2 is
// halved but for the leakage a = beta (c_E + c_I)/V_ms, which adds 2 zeta omega_n a = 150 a to it.
TEST(LinearPressureLoop, TwoSidedGainsOnOneSide) {
  const LinearPressureLoop loop(Clamped(ShippedModel("table1"), 1), {});
  const Complex pole = loop.LeastDampedPole(PaperGains(2));
  const double a = HandModel(1).a;
  EXPECT_NEAR(std::norm(pole), 150 * 150 / 2 + 150 * a, 0.1);
  EXPECT_NEAR(-2 * pole.real(), 150 + a, 1e-6);
  EXPECT_NEAR(std::abs(pole), 106.5, 0.05);
  EXPECT_NEAR(-pole.real() / std::abs(pole), 0.707, 0.0005);
}

// Tests that the sampled loop converges to the analog one, first by the half interval that holding delays.
TEST(LinearPressureLoop, SampledLoopTendsToAnalog) {
  const model::LinearModel model = Clamped(ShippedModel("table1"), 0);
  const LinearPressureLoop analog(model, {});
  const pressure_ctrl::PressureGains gains = PaperGains(2);
  for (const double interval : {1e-4, 1e-5}) {
    for (const int delay : {0, 1}) {
      const LinearPressureLoop sampled(model, {interval, delay});
      const double w = 2 * kPi * 30;
      const Complex ratio = sampled.LoopGain(gains, 30) / analog.LoopGain(gains, 30);
      EXPECT_NEAR(std::abs(ratio), 1, w * interval) << interval;
      EXPECT_NEAR(std::arg(ratio), -w * interval * (0.5 + delay), 0.01 * w * interval) << interval;
      EXPECT_NEAR(sampled.Growth(gains), analog.Growth(gains), 2 * 150 * 150 * interval);
    }
  }
  EXPECT_THROW(LinearPressureLoop(model, {0, 1}), std::invalid_argument);
  EXPECT_THROW(LinearPressureLoop(model, {1e-3, 2}), std::invalid_argument);
}

// Tests the largest stable gain with waves against Routh's criterion on a polynomial derived by hand.
TEST(LinearPressureLoop, GainLimitWithWavesMeetsRouth) {
  for (const double volume_fraction : {0.1, 0.4}) {
    for (const double damping : {0.005, 0.02}) {
      const model::ModelDescription model = WithWaves(volume_fraction, damping);
      const pressure_ctrl::PressureGains gains = PaperGains(2);
      const auto routh_stable = [&](double factor) {
        return RouthStable(
            WavePolynomial(model.parameters, 300, volume_fraction, damping, {factor * gains.k_p, gains.k_v}));
      };
      const LinearPressureLoop loop(Clamped(model, 0), {});
      const GainLimit limit = LargestStableFactor(loop, gains, 100);
      ASSERT_LT(limit.factor, 100);
      EXPECT_TRUE(routh_stable(limit.factor * (1 - 1e-6))) << volume_fraction << " " << damping;
      EXPECT_FALSE(routh_stable(limit.factor * (1 + 1e-6))) << volume_fraction << " " << damping;
      EXPECT_NEAR(limit.frequency_hz, 300, 10);
    }
  }
}

// Tests the sampled loop's limit on the actuator itself under the sampled law: oscillations decay just below
// it and grow just above it. Without Coulomb friction, which would stop them.
TEST(LinearPressureLoop, SampledLimitIsWhereTheActuatorStartsToOscillate) {
  model::ModelDescription model = ShippedModel("table1");
  model.parameters.T_s = 0;
  const double interval = 2e-3;
  const pressure_ctrl::PressureGains gains = PaperGains(2);
  const LinearPressureLoop loop(Clamped(model, 0), {interval, 1});
  const GainLimit limit = LargestStableFactor(loop, gains, 100);
  ASSERT_LT(limit.factor, 100);
  for (const double beside : {0.98, 1.02}) {
    const pressure_ctrl::PressureLawSettings law = {.gains = {beside * limit.factor * gains.k_p, gains.k_v},
                                                    .voltage_limit = 10};
    model::Actuator actuator(model, {.shaft = model::Shaft::kClamped, .initial_pressure = 1500});
    double voltage = 0;
    double early = 0;
    double late = 0;
    for (int k = 0; k < 400; ++k) {
      const model::Measurement m = actuator.Measure();
      const double next =
          pressure_ctrl::PressureLaw(
              law, {.pressure_ref = k == 0 ? 0.01 : 0, .p1 = m.p1, .p2 = m.p2, .motor_speed = m.motor_speed})
              .voltage;
      if (k >= 50 && k < 100) early = std::max(early, std::abs(m.p2 - m.p1));
      if (k >= 350) late = std::max(late, std::abs(m.p2 - m.p1));
      actuator.Advance(voltage, (k + 1) * interval);
      voltage = next;
    }
    const double growth = loop.LeastDampedPole(law.gains).real();
    EXPECT_NEAR(std::log(late / early) / (300 * interval), growth, 0.1 * std::abs(growth)) << beside;
    EXPECT_EQ(growth > 0, beside > 1);
  }
}

}  // namespace
}  // namespace hydro::design
