#include <gtest/gtest.h>

#include <array>

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

}  // namespace
}  // namespace hydro::testing
