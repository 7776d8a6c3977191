#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

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
