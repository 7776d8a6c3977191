#include <gtest/gtest.h>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

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

}  // namespace
}  // namespace hydro::testing
