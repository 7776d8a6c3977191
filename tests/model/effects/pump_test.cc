#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that the pumped volume is D (theta + amplitude/periods sin(periods theta)), and that the pump's
// torque has the same ripple.
TEST(FlowRipple, PumpsTheVolumeOfItsAngle) {
  const double a = 0.1, n = 9;
  Rig rig(Sealed({"pump.flow_ripple", {{"amplitude", a}, {"periods", n}}, {}}), HeldAt(1000));
  for (int i = 1; i <= 20; ++i) {
    rig.simulation->Advance(2.5, 0.005 * i);
    const model::Measurement m = rig.Measure();
    const double volume = 0.00796 * (m.motor_angle + a / n * std::sin(n * m.motor_angle));
    EXPECT_NEAR(m.p2 - 1000, kStiffness * volume, 1e-4);
    EXPECT_NEAR(m.p1 - 1000, -kStiffness * volume, 1e-4);
    const model::Terms<double> x = TermsOf(rig, 2.5);
    const double D = 0.00796 * (1 + a * std::cos(n * m.motor_angle));
    EXPECT_NEAR(x.net_torque, 10 - D * (m.p2 - m.p1), 1e-9);
  }
  EXPECT_GT(rig.Measure().motor_angle, 0.7);  // a whole period
}

// Tests break-away and steady speed in each direction.
TEST(FrictionAsymmetry, DiffersByDirection) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.bypass = true;
  const model::ModelDescription model =
      Table1Model({{"pump.friction_asymmetry", {{"coulomb", 1}, {"viscous", 0.005}}, {}}});
  const auto speed_at = [&](double torque) {
    model::Actuator actuator(model, options);
    actuator.Advance(torque / 4, 60);
    return actuator.Measure().motor_speed;
  };
  EXPECT_EQ(speed_at(4.99), 0);
  EXPECT_NEAR(speed_at(8), (8 - 5) / (0.01455 + 0.005), 1e-4);
  EXPECT_EQ(speed_at(-2.99), 0);
  EXPECT_NEAR(speed_at(-8), -(8 - 3) / (0.01455 - 0.005), 1e-4);
}

// Tests that the effect's f and the base parameter f are one term.
TEST(PressureFriction, IsThePapersF) {
  model::ModelDescription base = Table1Model();
  base.parameters.f = 0.002;
  model::Actuator a(base, Held(model::Shaft::kClamped));
  model::Actuator b(Table1Model({{"pump.pressure_friction", {{"f", 0.002}}, {}}}),
                    Held(model::Shaft::kClamped));
  model::Actuator without(Table1Model(), Held(model::Shaft::kClamped));
  for (model::Actuator* actuator : {&a, &b, &without}) actuator->Advance(2.5, 0.2);
  EXPECT_NEAR(a.Measure().p2, b.Measure().p2, 1e-6);
  EXPECT_LT(a.Measure().p2, without.Measure().p2 - 10);
}

// Tests that quadratic drag sets the steady speed of the bypassed pump: k w^2 + b w = T_p - T_s.
TEST(QuadraticDrag, SteadySpeed) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.bypass = true;
  for (const double sign : {1.0, -1.0}) {
    model::Actuator actuator(Table1Model({{"pump.quadratic_drag", {{"k", 1e-4}}, {}}}), options);
    actuator.Advance(sign * 2.5, 60);
    const double b = 0.01455, k = 1e-4;
    EXPECT_NEAR(actuator.Measure().motor_speed, sign * (-b + std::sqrt(b * b + 4 * k * 6)) / (2 * k), 1e-3);
  }
}

// Tests that the steady speed balances Cross's law and b: friction below that of a lubricant that keeps its
// viscosity.
TEST(ShearThinning, SteadySpeed) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.bypass = true;
  const double b = 0.01455, viscous = 0.05, half = 20, torque = 10 - 4;
  for (const double sign : {1.0, -1.0}) {
    model::Actuator actuator(
        Table1Model({{"pump.shear_thinning", {{"viscous", viscous}, {"speed", half}}, {}}}), options);
    actuator.Advance(sign * 2.5, 60);
    const double speed = actuator.Measure().motor_speed;
    EXPECT_GT(sign * speed, torque / (b + viscous) + 50);
    EXPECT_NEAR(b * speed + viscous * speed / (1 + std::abs(speed) / half), sign * torque, 1e-6);
  }
}

// Tests that the pressure difference of a pump at rest falls as an orifice allows: its square root falls
// linearly, at k beta/V.
TEST(TurbulentLeakage, RootFallsEvenly) {
  for (const double sign : {1.0, -1.0}) {
    Rig rig(Sealed({"pump.turbulent_leakage", {{"k", 2e-5}}, {}}), HeldAt(600));
    rig.simulation->Advance(sign * 1.5, 0.3);
    rig.simulation->Advance(0, 0.6);
    ASSERT_EQ(rig.simulation->mode(), model::Mode{});
    const double before = rig.Measure().p2 - rig.Measure().p1;
    ASSERT_GT(sign * before, 100);
    rig.simulation->Advance(0, 1.6);
    const double root = std::sqrt(sign * before) - kStiffness * 2e-5;
    EXPECT_NEAR(rig.Measure().p2 - rig.Measure().p1, sign * root * root, 0.01);
  }
}

// Tests that the orifice is at the pump, where a line lies between it and the actuator.
TEST(TurbulentLeakage, SeesThePumpsPressures) {
  model::ModelDescription model = Sealed({"pump.turbulent_leakage", {{"k", 2e-5}}, {}});
  model.effects.push_back(Wave(300, 0.2, 0.05));
  const model::Equations equations(model, Held(model::Shaft::kClamped));
  double rate[model::kMaxStates];
  const model::Terms<double> x = TermsAt(equations, {0, 0, 100, 300, 100, 0, 500, 0}, rate);
  EXPECT_NEAR(x.cross_flow, 2e-5 * std::sqrt(400), 1e-8);
}

// Tests that the flow is laminar below about 2e-4 T_pmax/D, 1 psi for Table 1, and the orifice's above.
TEST(TurbulentLeakage, LaminarAtSmallDifferences) {
  const model::Equations equations(Sealed({"pump.turbulent_leakage", {{"k", 2e-5}}, {}}),
                                   Held(model::Shaft::kClamped));
  const model::Parameters p = Table1();
  const double width = 2e-4 * p.T_pmax / p.D;
  EXPECT_NEAR(width, 1, 0.01);
  double rate[model::kMaxStates];
  for (const double dp : {-10.0, -1e-3, 0.0, 1e-3, 1.0, 10.0}) {
    const model::Terms<double> x = TermsAt(equations, {0, 0, 100, 100 + dp, 0, 0}, rate);
    EXPECT_NEAR(x.cross_flow, 2e-5 * dp / std::pow(dp * dp + width * width, 0.25), 1e-15) << dp;
  }
}

}  // namespace

}  // namespace hydro::testing
