#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that without friction the motor's energy is the work of its torque less that of the magnets, and that
// at rest friction has to hold the cogging torque too.
TEST(Cogging, IsConservativeAndHoldsAtRest) {
  const double A = 3, n = 7, phase = 0.4;
  model::ModelDescription model =
      Table1Model({{"motor.cogging", {{"amplitude", A}, {"periods", n}, {"phase", phase}}, {}}});
  model::ModelDescription slick = model;
  slick.parameters.T_s = slick.parameters.b = 0;
  Rig rig(slick, Bypassed());
  for (int i = 1; i <= 20; ++i) {
    rig.simulation->Advance(1, 0.01 * i);
    const model::Measurement m = rig.Measure();
    const double work = 4 * m.motor_angle - A / n * (std::cos(phase) - std::cos(n * m.motor_angle + phase));
    EXPECT_NEAR(0.5 * 0.03 * m.motor_speed * m.motor_speed, work, 1e-5 * (1 + work));
  }
  for (const double excess : {-1e-3, 1e-3}) {
    model::Actuator actuator(model, Bypassed());
    actuator.Advance((4 + A * std::sin(phase) + excess) / 4, 0.1);
    EXPECT_EQ(actuator.Measure().motor_angle > 0, excess > 0);
  }
}

}  // namespace
}  // namespace hydro::testing
