// Cases with a solution on paper.
#include <gtest/gtest.h>

#include <cmath>

#include "model/trajectory/trajectory.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

class ClosedForm : public ::testing::TestWithParam<model::Integrator> {};

// Tests that with the bypass open the pump settles at (k_1 v - T_s)/b with its time constant J/b, as the
// paper's experiment for b and T_s assumes.
TEST_P(ClosedForm, BypassSpeed) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped, GetParam());
  options.bypass = true;
  for (const double voltage : {1.5, 2.5, -4.0}) {
    model::Actuator actuator(Table1Model(), options);
    const double steady = std::copysign((4 * std::abs(voltage) - 4) / 0.01455, voltage);
    for (const double t : {0.5, 2.0, 60.0}) {
      actuator.Advance(voltage, t);
      EXPECT_NEAR(actuator.Measure().motor_speed, steady * (1 - std::exp(-t * 0.01455 / 0.03)), 1e-4);
      EXPECT_EQ(actuator.Measure().p1, actuator.Measure().p2);
    }
  }
}

// Tests that with the bypass open the common pressure leaks off to p_3: 2 V_ms p'/beta = -2 c_E (p - p_3).
TEST_P(ClosedForm, BypassPressure) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped, GetParam());
  options.bypass = true;
  options.initial_pressure = 400;
  model::Actuator actuator(Table1Model(), options);
  for (const double t : {0.5, 2.0, 5.0}) {
    actuator.Advance(3, t);
    EXPECT_NEAR(actuator.Measure().p1, 100 + 300 * std::exp(-247000 * 6.5e-6 / 3.16 * t), 1e-3);
  }
}

// Tests that a driven shaft compresses the trapped fluid as eq. (13) says: p1 = p_3 - beta ln(1 - c
// alpha/V_ms) without leakage, while side 2 is held at p_3 by its valve and the pump sticks.
TEST_P(ClosedForm, DrivenShaftCompresses) {
  model::ModelDescription model = Table1Model();
  model.parameters.c_E = model.parameters.c_I = 0;
  const auto motion = trajectory::MakePoints({{0.1, 0}, {0.3, 1e-3}}, trajectory::Interpolation::kLinear);
  model::ActuatorOptions options = Held(model::Shaft::kDriven, GetParam());
  options.motion = motion.get();
  model::Actuator actuator(model, options);
  for (const double t : {0.05, 0.1, 0.13, 0.2, 0.27, 0.3, 0.4}) {
    actuator.Advance(0, t);
    const double angle = motion->Value(t);
    const model::Measurement m = actuator.Measure();
    EXPECT_NEAR(m.p1, 100 - 247000 * std::log1p(-model.parameters.c * angle / 3.16), 1e-3) << "at " << t;
    EXPECT_EQ(m.p2, 100) << "at " << t;
    EXPECT_EQ(m.motor_speed, 0);
    EXPECT_EQ(m.arm_angle, angle);
  }
}

// Tests that a slowly driven shaft turns the pump through the fluid: once D dp exceeds T_s, the pump follows
// at theta' = (c/D) alpha' less leakage, and dp settles at -(T_s + b theta')/D.
TEST_P(ClosedForm, DrivenShaftTurnsThePump) {
  model::ModelDescription model = Table1Model();
  model.parameters.c_E = model.parameters.c_I = 0;
  const auto motion = trajectory::MakePoints({{0, 0}, {40, 0.4}}, trajectory::Interpolation::kLinear);
  model::ActuatorOptions options = Held(model::Shaft::kDriven, GetParam());
  options.motion = motion.get();
  model::Actuator actuator(model, options);
  actuator.Advance(0, 30);
  const model::Measurement m = actuator.Measure();
  const double speed = model.parameters.c / 0.00796 * 0.01;
  EXPECT_NEAR(m.motor_speed, speed, 0.01 * speed);
  EXPECT_NEAR(m.p2 - m.p1, -(4 + 0.01455 * speed) / 0.00796, 2);
}

// Tests that a free arm under gravity alone, with the bypass open, is a pendulum: its energy is kept, and a
// quarter period of small motion about the bottom takes pi/2 sqrt(J_a/mgl).
TEST_P(ClosedForm, Pendulum) {
  model::ModelDescription model = Table1Model();
  model.parameters.mgl = 562;
  model.parameters.V_ms = 10;  // room to hang
  model::ActuatorOptions options = Held(model::Shaft::kFree, GetParam());
  options.bypass = true;
  options.arm_angle = -1.5707963267948966 + 0.01;
  model::Actuator actuator(model, options);
  actuator.Advance(0, 1.5707963267948966 * std::sqrt(23.3 / 562));
  EXPECT_NEAR(actuator.Measure().arm_angle, -1.5707963267948966, 1e-6);
  EXPECT_NEAR(actuator.Measure().arm_speed, -0.01 * std::sqrt(562 / 23.3), 1e-6);
}

// Tests that the clamped arm stays where it was put, with the volumes of that angle: side 1 is smaller, so
// its pressure rises faster under the same flow.
TEST_P(ClosedForm, ClampedAwayFromMidstroke) {
  model::ModelDescription model = Table1Model();
  model.parameters.c_E = model.parameters.c_I = 0;
  model::ActuatorOptions options = Held(model::Shaft::kClamped, GetParam());
  options.arm_angle = 0.4;
  model::Actuator actuator(model, options);
  actuator.Advance(-2.5, 0.05);
  const model::Measurement m = actuator.Measure();
  EXPECT_EQ(m.arm_angle, 0.4);
  EXPECT_EQ(m.arm_speed, 0);
  const double V_1 = 3.16 - model.parameters.c * 0.4;
  EXPECT_NEAR(m.p1 - 100, -247000 / V_1 * 0.00796 * m.motor_angle, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Paths, ClosedForm, ::testing::ValuesIn(kIntegrators),
                         [](const auto& test) { return Name(test.param); });

}  // namespace
}  // namespace hydro::testing
