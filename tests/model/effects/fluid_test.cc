#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Time in which the external leakage c_E takes both sides from `high` to `low`: the integral of V dp over
// beta(p) c_E (p - p_3), by Simpson's rule.
double TimeToFall(double high, double low, double c_E, const std::function<double(double)>& beta) {
  const int steps = 2000;
  double time = 0;
  for (int i = 0; i <= steps; ++i) {
    const double p = low + (high - low) * i / steps;
    const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
    time += weight * 3.16 / (beta(p) * c_E * (p - 100)) * (high - low) / steps / 3;
  }
  return time;
}

// Tests that pressure falls as the fluid's modulus says at each pressure: 1/beta plus that of air of which a
// volume 0.02 at 14.6959 psi has become 0.02 (p_atm/p)^(1/1.4).
TEST(EntrainedAir, SoftAtLowPressure) {
  const auto beta = [](double p) {
    const double absolute = p + 14.6959;
    return 1 / (1 / 247000.0 + 0.02 / (1.4 * absolute) * std::pow(14.6959 / absolute, 1 / 1.4));
  };
  model::Actuator actuator(Sealed({"fluid.entrained_air", {{"air_fraction", 0.02}}, {}}, 1e-4), HeldAt(800));
  actuator.Advance(0, TimeToFall(800, 150, 1e-4, beta));
  EXPECT_NEAR(actuator.Measure().p1, 150, 0.01);
  EXPECT_LT(beta(150), 0.4 * beta(800));

  const model::Equations equations(Sealed({"fluid.entrained_air", {{"air_fraction", 0.02}}, {}}),
                                   Held(model::Shaft::kClamped));
  double rate[model::kMaxStates];
  const model::Terms<double> x = TermsAt(equations, {0, 0, 150, 800}, rate);  // each side has its own
  EXPECT_NEAR(x.beta_1, beta(150), 1e-4 * beta(150));
  EXPECT_NEAR(x.beta_2, beta(800), 1e-4 * beta(800));
}

// Tests that air stays soft and finite down to a vacuum and below.
TEST(EntrainedAir, IsFiniteInAVacuum) {
  const model::Equations equations(Sealed({"fluid.entrained_air", {{"air_fraction", 0.02}}, {}}),
                                   Held(model::Shaft::kClamped));
  double last = 1e9;
  for (const double p : {100.0, 0.0, -14.0, -14.6959, -16.0, -100.0}) {
    const double state[4] = {0, 0, p, p};
    double rate[4];
    model::Terms<double> x;
    equations.Evaluate(0, 0, model::Mode{}, state, rate, &x);
    EXPECT_GT(x.beta_1, 0) << p;
    EXPECT_LT(x.beta_1, last) << p;
    last = x.beta_1;
  }
}

// Tests the same where the modulus grows with pressure, and that only the liquid's does beside air.
TEST(Stiffening, StiffAtHighPressure) {
  const auto beta = [](double p) { return 247000 + 200 * p; };
  const model::EffectDescription stiffening = {"fluid.stiffening", {{"slope", 200}}, {}};
  model::Actuator actuator(Sealed(stiffening, 1e-4), HeldAt(800));
  actuator.Advance(0, TimeToFall(800, 150, 1e-4, beta));
  EXPECT_NEAR(actuator.Measure().p1, 150, 1e-3);
  const model::Equations equations(Sealed(stiffening), Held(model::Shaft::kClamped));
  double rate[model::kMaxStates];
  const model::Terms<double> x = TermsAt(equations, {0, 0, 150, 800}, rate);  // each side has its own
  EXPECT_DOUBLE_EQ(x.beta_1, beta(150));
  EXPECT_DOUBLE_EQ(x.beta_2, beta(800));

  model::ModelDescription both = Sealed(stiffening, 1e-4);
  both.effects.push_back({"fluid.entrained_air", {{"air_fraction", 0.02}}, {}});
  const auto beta_both = [&](double p) {
    const double absolute = p + 14.6959;
    return 1 / (1 / beta(p) + 0.02 / (1.4 * absolute) * std::pow(14.6959 / absolute, 1 / 1.4));
  };
  model::Actuator with_air(both, HeldAt(800));
  with_air.Advance(0, TimeToFall(800, 150, 1e-4, beta_both));
  EXPECT_NEAR(with_air.Measure().p1, 150, 0.01);
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

}  // namespace

}  // namespace hydro::testing
