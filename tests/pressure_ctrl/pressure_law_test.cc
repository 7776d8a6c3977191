#include "pressure_ctrl/law/pressure_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <stdexcept>

#include "model/linearise.h"
#include "tests/table1.h"

namespace hydro::pressure_ctrl {
namespace {

using testing::Table1;

// Eigenvalues of the closed loop of eqs. (4), (13), (14), (16) at alpha = 0, frictionless and without
// leakage, written out here from the equations themselves: states p1, p2, theta'; side 1 at p_3 when only one
// side compresses.
SecondOrder ClosedLoop(const model::Parameters& p, const PressureGains& gains, int compressed_sides) {
  const double rise2 = p.beta / p.V_ms * p.D;                               // d p2'/d theta', eq. (14)
  const double rise1 = compressed_sides == 2 ? -p.beta / p.V_ms * p.D : 0;  // d p1'/d theta', eq. (13)
  // dp' = (rise2 - rise1) theta';  J theta'' = -k_1 k_p dp - k_1 k_p k_v theta' - D dp - b theta'
  const double trace = -(p.k_1 * gains.k_p * gains.k_v + p.b) / p.J;
  const double determinant = (rise2 - rise1) * (p.k_1 * gains.k_p + p.D) / p.J;
  const std::complex<double> root =
      (trace + std::sqrt(std::complex<double>(trace * trace - 4 * determinant))) / 2.0;
  return {std::abs(root), -root.real() / std::abs(root)};
}

// The model's own linearisation with the arm held there; with one side, valve 1 holds side 1 at p_3.
model::LinearModel Linear(const model::ModelDescription& model, double arm_angle, int sides) {
  model::ActuatorOptions options;
  options.shaft = model::Shaft::kClamped;
  options.arm_angle = arm_angle;
  model::Mode mode;
  mode.pump = 1;
  mode.valve_1 = sides == 1;
  const double state[] = {0, 1, 100, 400};
  return model::Linearise(model::Equations(model, options), 0, 0, mode, state);
}

// Tests that natural frequency 150 rad/s and damping 0.5 give the gains computed independently from the
// paper's equations, for both volumes compressing and for one side held at p_3.
TEST(PressureLawTest, DerivedGainsMatchThePaper) {
  const PressureGains two = DerivePressureGains(Table1(), 0, 150, 0.5, 2);
  EXPECT_NEAR(two.k_p, 0.1336, 5e-5);
  EXPECT_NEAR(two.k_v, 8.39, 5e-3);
  const PressureGains one = DerivePressureGains(Table1(), 0, 150, 0.5, 1);
  EXPECT_NEAR(one.k_p, 0.269, 5e-4);
  EXPECT_NEAR(one.k_v, 4.17, 5e-3);
}

// Tests, by eigenvalues, that the derived gains place the linearised loop's poles where requested.
TEST(PressureLawTest, DerivedGainsGiveTheLoopAskedFor) {
  for (const int sides : {1, 2}) {
    for (const double omega : {60.0, 150.0, 400.0}) {
      const SecondOrder loop =
          ClosedLoop(Table1(), DerivePressureGains(Table1(), 0, omega, 0.5, sides), sides);
      EXPECT_NEAR(loop.natural_frequency, omega, 1e-9 * omega);
      EXPECT_NEAR(loop.damping_ratio, 0.5, 1e-9);
    }
  }
}

// Tests the same away from mid-stroke, where the two volumes differ, on the model's own linearisation.
TEST(PressureLawTest, DerivedGainsGiveTheLoopAskedForAwayFromMidstroke) {
  model::ModelDescription model;
  model.parameters = Table1();
  for (const double arm_angle : {0.4, -0.6}) {
    for (const int sides : {1, 2}) {
      const model::LinearModel linear = Linear(model, arm_angle, sides);
      const auto A = [&](int i, int j) { return linear.A[i + j * 4]; };
      const PressureGains gains = DerivePressureGains(model.parameters, arm_angle, 150, 0.5, sides);
      // v = -k_p (dp + k_v theta') closes the loop of dp' = rise theta' and theta'' = A theta' + A dp + B v.
      const double rise = A(model::kP2, model::kMotorSpeed) - A(model::kP1, model::kMotorSpeed);
      const double B = linear.B[model::kMotorSpeed];
      const double omega = std::sqrt(rise * (B * gains.k_p - A(model::kMotorSpeed, model::kP2)));
      EXPECT_NEAR(omega, 150, 1e-9) << arm_angle << ", " << sides;
      EXPECT_NEAR((B * gains.k_p * gains.k_v - A(model::kMotorSpeed, model::kMotorSpeed)) / (2 * omega), 0.5,
                  1e-12);
      const SecondOrder loop = PressureLoopDynamics(model.parameters, arm_angle, gains, sides);
      EXPECT_NEAR(loop.natural_frequency, 150, 1e-9);
      EXPECT_NEAR(loop.damping_ratio, 0.5, 1e-12);
    }
  }
}

// Tests the same where areas, volumes and the pump's ports are unequal, for the load pressure that then takes
// the place of dp.
TEST(PressureLawTest, DerivedGainsServeUnequalSides) {
  model::ModelDescription model;
  model.parameters = Table1();
  model.effects = {{"actuator.unequal_areas", {{"difference", 0.2}}, {}},
                   {"actuator.unequal_volumes", {{"difference", -0.1}}, {}},
                   {"pump.unequal_displacements", {{"difference", 0.15}}, {}}};
  const model::Differences differ = model::DifferencesOf(model);
  for (const double arm_angle : {0.0, 0.3}) {
    for (const int sides : {1, 2}) {
      const model::LinearModel linear = Linear(model, arm_angle, sides);
      const auto A = [&](int i, int j) { return linear.A[i + j * 4]; };
      const PressureGains gains = DerivePressureGains(model.parameters, arm_angle, 150, 0.5, sides, differ);
      const double rise_1 = A(model::kP1, model::kMotorSpeed), rise_2 = A(model::kP2, model::kMotorSpeed);
      const double own =
          A(model::kMotorSpeed, model::kP1) * rise_1 + A(model::kMotorSpeed, model::kP2) * rise_2;
      const double B = linear.B[model::kMotorSpeed];
      const double omega = std::sqrt((1.2 * rise_2 - 0.8 * rise_1) * B * gains.k_p - own);
      EXPECT_NEAR(omega, 150, 1e-9) << arm_angle << ", " << sides;
      EXPECT_NEAR((B * gains.k_p * gains.k_v - A(model::kMotorSpeed, model::kMotorSpeed)) / (2 * omega), 0.5,
                  1e-12);
      EXPECT_NEAR(PressureLoopDynamics(model.parameters, arm_angle, gains, sides, differ).natural_frequency,
                  150, 1e-9);
    }
  }
}

// Tests that with unequal sides the loop holds c_2 p2 - c_1 p1 over c, and that its feed-forward is the
// torque that the pump needs while the side without load is at p_3, whichever side that is.
TEST(PressureLawTest, HoldsTheLoadPressureOfUnequalSides) {
  const double areas = 0.2, displacements = 0.1, charge = 100;
  PressureLawSettings settings;
  settings.gains = {0.125, 8};
  settings.voltage_limit = 1000;
  settings.sides = {areas, displacements, charge};
  settings.reference_feedforward = 0.002;
  const double out_p2 = 500, out = 1.2 * out_p2 - 0.8 * charge;
  EXPECT_NEAR(PressureLaw(settings, {out, charge, out_p2, 0, 0}).voltage, 0.002 * 1.1 * (out_p2 - charge),
              1e-12);
  const double in_p1 = 700, in = 1.2 * charge - 0.8 * in_p1;
  EXPECT_NEAR(PressureLaw(settings, {in, in_p1, charge, 0, 0}).voltage, -0.002 * 0.9 * (in_p1 - charge),
              1e-12);
  // The pump's speed by the arm's: c_2/D_2 under load on side 2, c_1/D_1 on side 1.
  settings.reference_feedforward = 0;
  settings.arm_speed_ratio = 460;
  EXPECT_NEAR(PressureLaw(settings, {out, charge, out_p2, 460 * 1.2 / 1.1 * 0.3, 0.3}).voltage, 0, 1e-12);
  EXPECT_NEAR(PressureLaw(settings, {in, in_p1, charge, 460 * 0.8 / 0.9 * 0.3, 0.3}).voltage, 0, 1e-12);
}

// Tests that the two-sided gains leave the one-sided mode slower by sqrt(2) and better damped by as much.
TEST(PressureLawTest, TwoSidedGainsInTheOneSidedMode) {
  const PressureGains gains = DerivePressureGains(Table1(), 0, 150, 0.5, 2);
  const SecondOrder loop = PressureLoopDynamics(Table1(), 0, gains, 1);
  EXPECT_NEAR(loop.natural_frequency, 150 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(loop.damping_ratio, 0.5 * std::sqrt(2.0), 1e-12);
}

// Tests the closed loop with leakage and the rounded gains k_p = 0.134, k_v = 8.4 in the one-sided mode
// against values computed independently: 106.6 rad/s, damping 0.709. Leakage moves the frequency by 0.4 %,
// which the derivation leaves out.
TEST(PressureLawTest, LeakageMovesTheLoopLittle) {
  const model::Parameters p = Table1();
  const PressureGains gains{0.134, 8.4};
  const SecondOrder loop = PressureLoopDynamics(p, 0, gains, 1);
  // dp' = s theta' - l dp adds l (b + k_1 k_p k_v)/J to omega^2 and l to 2 zeta omega.
  const double l = p.beta / p.V_ms * (p.c_I + p.c_E);
  const double damping = (p.b + p.k_1 * gains.k_p * gains.k_v) / p.J;
  const double omega = std::sqrt(loop.natural_frequency * loop.natural_frequency + l * damping);
  EXPECT_NEAR(omega, 106.6, 0.05);
  EXPECT_NEAR((damping + l) / (2 * omega), 0.709, 5e-4);
  EXPECT_NEAR(loop.natural_frequency / omega, 1, 0.005);
}

// Tests that impossible gains are refused instead of turned into positive feedback.
TEST(PressureLawTest, RefusesAFrequencyBelowTheOpenLoop) {
  EXPECT_THROW(DerivePressureGains(Table1(), 0, 15, 0.5, 2), std::invalid_argument);  // open loop: 18.2 rad/s
  EXPECT_NO_THROW(DerivePressureGains(Table1(), 0, 15, 0.5, 1));                      // open loop: 12.9 rad/s
  EXPECT_THROW(DerivePressureGains(Table1(), 0, 150, 0.5, 3), std::invalid_argument);
}

// Tests eq. (16) term by term against numbers worked out by hand.
TEST(PressureLawTest, IsEquation16) {
  PressureLawSettings settings;
  settings.gains = {0.125, 8};
  settings.voltage_limit = 1000;
  // dp = 100, error = 200, minus k_v theta' = 8 * 5
  EXPECT_DOUBLE_EQ(PressureLaw(settings, {300, 100, 200, 5, 7}).voltage, 0.125 * (200 - 40));
  settings.reference_feedforward = 0.002;
  EXPECT_DOUBLE_EQ(PressureLaw(settings, {300, 100, 200, 5, 7}).voltage, 0.125 * (200 - 40) + 0.6);
  settings.arm_speed_ratio = 0.5;
  EXPECT_DOUBLE_EQ(PressureLaw(settings, {300, 100, 200, 5, 7}).voltage, 0.125 * (200 - 8 * 1.5) + 0.6);
}

// Tests that the output saturates at +/- the voltage limit and says so.
TEST(PressureLawTest, Saturates) {
  PressureLawSettings settings;
  settings.gains = {1, 0};
  settings.voltage_limit = 10;
  const PressureLawInput inside{10, 0, 0, 0, 0};
  EXPECT_EQ(PressureLaw(settings, inside).voltage, 10);
  EXPECT_FALSE(PressureLaw(settings, inside).saturated);
  EXPECT_EQ(PressureLaw(settings, {10.5, 0, 0, 0, 0}).voltage, 10);
  EXPECT_TRUE(PressureLaw(settings, {10.5, 0, 0, 0, 0}).saturated);
  EXPECT_EQ(PressureLaw(settings, {-1e9, 0, 0, 0, 0}).voltage, -10);
}

// Tests that the feed-forward removes the steady-state error of the frictionless clamped actuator: at dp =
// dp_ref, with the speed that makes up for the leakage, the law's torque is what eq. (4) needs.
TEST(PressureLawTest, FeedforwardHoldsTheReference) {
  model::Parameters p = Table1();
  const PressureGains gains = DerivePressureGains(p, 0, 150, 0.5, 2);
  PressureLawSettings settings{gains, 10, SteadyStateFeedforward(p, gains), 0};
  const double dp = 300;
  const double speed = (p.c_I * dp + p.c_E * dp) / p.D;  // eq. (14) at rest, p1 = p_3
  const double voltage = PressureLaw(settings, {dp, p.p_3, p.p_3 + dp, speed, 0}).voltage;
  EXPECT_NEAR(p.k_1 * voltage, p.D * dp + p.b * speed, 1e-12);
}

}  // namespace
}  // namespace hydro::pressure_ctrl
