#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

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

}  // namespace
}  // namespace hydro::testing
