#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

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

}  // namespace
}  // namespace hydro::testing
