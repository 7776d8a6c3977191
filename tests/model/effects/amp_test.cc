#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that a bias adds to the torque whatever the command is: the bypassed pump ends at T_p + bias = T_s +
// b w, also where the amplifier's limit holds T_p.
TEST(Bias, AddsToTheTorque) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.bypass = true;
  const model::Parameters p = Table1();
  for (const auto& [voltage, torque] : {std::array{2.5, 10.0}, {1000.0, p.T_pmax}}) {
    model::Actuator actuator(Table1Model({{"amp.bias", {{"bias", -1}}, {}}}), options);
    actuator.Advance(voltage, 60);
    EXPECT_NEAR(actuator.Measure().motor_speed, (torque - 1 - p.T_s) / p.b, 1e-3);
  }
}

// Tests that a bias alone moves a pump whose friction it exceeds, and leaves one at rest whose friction it
// does not.
TEST(Bias, HasToOvercomeFriction) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.bypass = true;
  const model::Parameters p = Table1();
  model::Actuator held(Table1Model({{"amp.bias", {{"bias", 0.9 * p.T_s}}, {}}}), options);
  held.Advance(0, 1);
  EXPECT_EQ(held.Measure().motor_angle, 0);
  model::Actuator turns(Table1Model({{"amp.bias", {{"bias", -1.5 * p.T_s}}, {}}}), options);
  turns.Advance(0, 60);
  EXPECT_NEAR(turns.Measure().motor_speed, -0.5 * p.T_s / p.b, 1e-3);
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

}  // namespace

}  // namespace hydro::testing
