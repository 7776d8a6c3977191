// Effects against their own equations.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that the lagged torque follows its closed form, and that the pump starts when it passes T_s.
TEST(AmpLag, FollowsItsClosedForm) {
  const double tau = 0.01;
  for (const model::Integrator integrator : kIntegrators) {
    Rig rig(Table1Model({Lag(tau)}), Held(model::Shaft::kClamped, integrator));
    const double start = -tau * std::log(1 - 4.0 / 8.0);  // T = 8 (1 - exp(-t/tau)) reaches T_s = 4
    rig.simulation->Advance(2, start - 1e-6);
    EXPECT_EQ(rig.Measure().motor_speed, 0) << Name(integrator);
    rig.simulation->Advance(2, start + 1e-5);
    EXPECT_GT(rig.Measure().motor_speed, 0) << Name(integrator);
    rig.simulation->Advance(2, 0.025);
    EXPECT_NEAR(rig.simulation->now().state[4], 8 * (1 - std::exp(-2.5)), 1e-5) << Name(integrator);
    rig.simulation->Advance(-1, 0.045);
    const double then = 8 * (1 - std::exp(-2.5));
    EXPECT_NEAR(rig.simulation->now().state[4], -4 + (then + 4) * std::exp(-2.0), 1e-5) << Name(integrator);
  }
}

// Tests that the limit applies to the lagged torque: T_p stays at T_pmax while the lagged state is above it.
TEST(AmpLag, LimitsTheTorqueItself) {
  const double tau = 0.01;
  Rig rig(Table1Model({Lag(tau)}), Held(model::Shaft::kClamped));
  const auto torque = [&] {
    double rate[model::kMaxStates];
    model::Terms<double> x;
    const model::Point& now = rig.simulation->now();
    rig.equations.Evaluate(now.time, 20, rig.simulation->mode(), now.state, rate, &x);
    return x.torque;
  };
  const double limit_time = -tau * std::log(1 - 0.5);  // T = 80 (1 - exp(-t/tau)) reaches 40
  rig.simulation->Advance(20, limit_time - 1e-7);
  EXPECT_EQ(rig.simulation->mode().effects[0], 0);
  EXPECT_NEAR(torque(), 40, 1e-2);
  rig.simulation->Advance(20, limit_time + 1e-7);
  EXPECT_EQ(rig.simulation->mode().effects[0], 1);
  EXPECT_EQ(torque(), 40);
  rig.simulation->Advance(20, 0.03);
  EXPECT_EQ(torque(), 40);
  // Back within the limit: 80 (1 - exp(-3)) exp(-t/tau) falls to 40.
  const double release = 0.03 + tau * std::log(2 * (1 - std::exp(-3.0)));
  rig.simulation->Advance(0, release - 1e-6);
  EXPECT_EQ(rig.simulation->mode().effects[0], 1);
  rig.simulation->Advance(0, release + 1e-6);
  EXPECT_EQ(rig.simulation->mode().effects[0], 0);
}

// Tests that an effect of zero size changes nothing.
TEST(Effects, VanishWithTheirSize) {
  const std::vector<model::EffectDescription> none = {Stribeck(0, 3),
                                                      {"pump.pressure_friction", {{"f", 0}}, {}},
                                                      {"pump.quadratic_drag", {{"k", 0}}, {}},
                                                      {"sensor.pressure_offset", {{"p1", 0}, {"p2", 0}}, {}}};
  for (const model::EffectDescription& effect : none) {
    model::Actuator plain(Table1Model(), Held(model::Shaft::kClamped));
    model::Actuator with(Table1Model({effect}), Held(model::Shaft::kClamped));
    for (int tick = 0; tick < 1000; ++tick) {
      plain.Advance(SquareWaveLoop(plain.Measure(), tick), (tick + 1) * 2e-4);
      with.Advance(SquareWaveLoop(with.Measure(), tick), (tick + 1) * 2e-4);
      ASSERT_NEAR(plain.Measure().p2, with.Measure().p2, 1e-8) << effect.id;
      ASSERT_NEAR(plain.Measure().p1, with.Measure().p1, 1e-8) << effect.id;
    }
  }
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

// Tests that a delayed command acts exactly `delay` later, even when several are under way.
TEST(AmpDelay, ShiftsTheCommand) {
  for (const model::Integrator integrator : kIntegrators) {
    model::Actuator plain(Table1Model(), Held(model::Shaft::kClamped, integrator));
    model::Actuator delayed(Table1Model({{"amp.delay", {{"delay", 7.7e-4}}, {}}}),
                            Held(model::Shaft::kClamped, integrator));
    delayed.Advance(0.5, 2e-4);  // below friction
    plain.Advance(0, 9.7e-4);
    for (int tick = 0; tick < 300; ++tick) {
      const double voltage = 2.6 + std::sin(tick);
      delayed.Advance(voltage, 2e-4 * (tick + 2));
      plain.Advance(voltage, 9.7e-4 + 2e-4 * (tick + 1));
    }
    delayed.Advance(0, plain.time());
    EXPECT_NEAR(delayed.Measure().p2, plain.Measure().p2, 1e-4) << Name(integrator);
    EXPECT_NEAR(delayed.Measure().motor_speed, plain.Measure().motor_speed, 1e-6) << Name(integrator);
    EXPECT_GT(delayed.Measure().p2, 110);
  }
}

// Tests that seal friction holds the arm until its torque exceeds `coulomb`, and never moves it by itself.
TEST(SealFriction, SticksAndSlips) {
  model::ModelDescription model =
      Table1Model({{"actuator.seal_friction", {{"coulomb", 600}, {"viscous", 0}}, {}}});
  model.parameters.mgl = 562;
  model::Actuator holds(model, Held(model::Shaft::kFree));
  holds.Advance(0, 10);
  EXPECT_EQ(holds.Measure().arm_angle, 0);
  Rig pushed(model, Held(model::Shaft::kFree));
  double dp = 0;
  for (int tick = 1; pushed.Measure().arm_speed == 0; ++tick) {
    ASSERT_LT(tick, 100000);
    dp = pushed.Measure().p2 - pushed.Measure().p1;
    pushed.simulation->Advance(5, tick * 1e-5);
  }
  EXPECT_NEAR(3.68 * dp - 562, 600, 1);
  EXPECT_GT(pushed.Measure().arm_speed, 0);
}

// Tests that seal friction slows a swinging arm evenly: with the bypass open it swings down by coulomb's
// work.
TEST(SealFriction, TakesItsWork) {
  model::ModelDescription model =
      Table1Model({{"actuator.seal_friction", {{"coulomb", 50}, {"viscous", 0}}, {}}});
  model.parameters.mgl = 562;
  model.parameters.V_ms = 10;
  model::ActuatorOptions options = Held(model::Shaft::kFree);
  options.bypass = true;
  options.arm_angle = -0.5;
  Rig rig(model, options);
  rig.simulation->Advance(0, 0.2);
  const model::Measurement m = rig.Measure();
  const double fallen = 562 * (std::sin(-0.5) - std::sin(m.arm_angle));
  EXPECT_NEAR(0.5 * 23.3 * m.arm_speed * m.arm_speed, fallen - 50 * (-0.5 - m.arm_angle), 1e-5);
  rig.simulation->Advance(0, 30);
  EXPECT_EQ(rig.Measure().arm_speed, 0);  // it comes to rest where 50 in-lbf hold it
  EXPECT_LE(std::abs(562 * std::cos(rig.Measure().arm_angle)), 50);
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

// Tests that leakage drifts: with the bypass open the common pressure leaks off at a growing rate.
TEST(Warming, LeakageDrifts) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.bypass = true;
  options.initial_pressure = 400;
  model::Actuator actuator(Table1Model({{"fluid.warming", {{"rate", 0.3}}, {}}}), options);
  actuator.Advance(0, 2);
  const double decay = 247000 * 6.5e-6 / 3.16 * (std::exp(0.3 * 2) - 1) / 0.3;
  EXPECT_NEAR(actuator.Measure().p1, 100 + 300 * std::exp(-decay), 1e-4);
}

// Tests that internal leakage drifts too: with the pump stuck and both valves closed, the pressure difference
// leaks off at beta/V_ms (2 c_I + c_E) exp(rate t).
TEST(Warming, InternalLeakageDrifts) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.initial_pressure = 400;
  Rig rig(Table1Model({{"fluid.warming", {{"rate", 0.3}}, {}}}), options);
  rig.simulation->Advance(1.2, 0.3);
  rig.simulation->Advance(0, 0.6);
  ASSERT_EQ(rig.simulation->mode(), model::Mode{});
  const model::Measurement before = rig.Measure();
  ASSERT_GT(before.p2 - before.p1, 50);
  rig.simulation->Advance(0, 1.6);
  const model::Measurement after = rig.Measure();
  const double decay =
      247000 / 3.16 * (2 * 1.0e-6 + 6.5e-6) * (std::exp(0.3 * 1.6) - std::exp(0.3 * 0.6)) / 0.3;
  EXPECT_NEAR(after.p2 - after.p1, (before.p2 - before.p1) * std::exp(-decay), 1e-4);
}

// Tests that viscous friction falls: the bypassed pump then runs up as J w' = T_p - T_s - b exp(-rate t) w
// says, w = integral of (T_p - T_s)/J exp(B(s) - B(t)) ds with B = b/J (1 - exp(-rate t))/rate.
TEST(Warming, ViscousFrictionDrifts) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.bypass = true;
  model::Actuator actuator(Table1Model({{"fluid.warming", {{"rate", 0.3}}, {}}}), options);
  const double until = 2;
  actuator.Advance(2.5, until);
  const auto growth = [](double t) { return 0.01455 / 0.03 * (1 - std::exp(-0.3 * t)) / 0.3; };
  double speed = 0;  // by Simpson's rule
  const int steps = 200;
  for (int i = 0; i <= steps; ++i) {
    const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
    speed += weight * 6 / 0.03 * std::exp(growth(until * i / steps) - growth(until)) * until / steps / 3;
  }
  EXPECT_NEAR(actuator.Measure().motor_speed, speed, 1e-5);
}

// Tests that a gain affects measurements only.
TEST(PressureGain, ScalesTheMeasurement) {
  model::Actuator plain(Table1Model(), Held(model::Shaft::kClamped));
  model::Actuator with(Table1Model({{"sensor.pressure_gain", {{"gain", 0.02}}, {}}}),
                       Held(model::Shaft::kClamped));
  plain.Advance(2.5, 0.2);
  with.Advance(2.5, 0.2);
  EXPECT_NEAR(with.Measure().p1, plain.Measure().p1 * 1.02, 1e-6);
  EXPECT_NEAR(with.Measure().p2, plain.Measure().p2 * 1.02, 1e-6);
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

// Tests that offsets affect measurements and not the motion.
TEST(PressureOffset, ShiftsTheMeasurementOnly) {
  model::Actuator plain(Table1Model(), Held(model::Shaft::kClamped));
  model::Actuator with(Table1Model({{"sensor.pressure_offset", {{"p1", 3}, {"p2", -2}}, {}}}),
                       Held(model::Shaft::kClamped));
  plain.Advance(2.5, 0.2);
  with.Advance(2.5, 0.2);
  EXPECT_NEAR(with.Measure().p1, plain.Measure().p1 + 3, 1e-6);
  EXPECT_NEAR(with.Measure().p2, plain.Measure().p2 - 2, 1e-6);
}

// Tests that the pump is where the line says: the actuator's pressure lags behind the pump's when flow
// starts.
TEST(LineWave, PumpSideMovesFirst) {
  Rig rig(Table1Model({Wave(300, 0.2, 0.05)}), Held(model::Shaft::kClamped));
  rig.simulation->Advance(10, 2e-4);
  const double* state = rig.simulation->now().state;
  EXPECT_GT(state[6] - 100, 2 * (state[model::kP2] - 100));
  EXPECT_GT(state[model::kP2], 100);
  EXPECT_EQ(rig.equations.StateNames()[6], "pump_p2");
}

// Tests that the order in the file does not matter.
TEST(Effects, OrderDoesNotMatter) {
  model::Actuator a(Table1Model({Stribeck(0.5, 3), Lag(2e-3), Wave(300, 0.2, 0.05)}),
                    Held(model::Shaft::kFree));
  model::Actuator b(Table1Model({Wave(300, 0.2, 0.05), Stribeck(0.5, 3), Lag(2e-3)}),
                    Held(model::Shaft::kFree));
  a.Advance(2.5, 0.1);
  b.Advance(2.5, 0.1);
  EXPECT_EQ(a.Measure().p2, b.Measure().p2);
}

}  // namespace
}  // namespace hydro::testing
