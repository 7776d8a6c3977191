#include "model/started_actuator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/terms/model_error.h"
#include "model/terms/state.h"
#include "tests/model/model_case.h"

namespace hydro::model {
namespace {

using testing::Table1Model;

StartState StateOf(const Measurement& measured) {
  StartState start{};
  start[kMotorAngle] = measured.motor_angle;
  start[kMotorSpeed] = measured.motor_speed;
  start[kP1] = measured.p1;
  start[kP2] = measured.p2;
  start[kArmAngle] = measured.arm_angle;
  start[kArmSpeed] = measured.arm_speed;
  return start;
}

double Voltage(double time) { return 4 * std::sin(9 * time); }

// Tests that an actuator that begins in the state of another, at its time and in the middle of its motion,
// moves as that one, to what the integration's tolerance of 1e-8 leaves: free and with the shaft clamped.
TEST(StartedActuatorTest, GoesOnAsTheOther) {
  for (const Shaft shaft : {Shaft::kFree, Shaft::kClamped}) {
    ActuatorOptions options;
    options.shaft = shaft;
    options.arm_angle = 0.1;
    options.initial_pressure = 100;
    Actuator whole(Table1Model(), options);
    for (int k = 0; k < 300; ++k) whole.Advance(Voltage(k * 1e-3), (k + 1) * 1e-3);
    StartedActuator begun(Table1Model(), options, StateOf(whole.Measure()), whole.time());
    EXPECT_EQ(begun.time(), whole.time());
    EXPECT_EQ(begun.Measure().p1, whole.Measure().p1);
    for (int k = 300; k < 900; ++k) {
      whole.Advance(Voltage(k * 1e-3), (k + 1) * 1e-3);
      begun.Advance(Voltage(k * 1e-3), (k + 1) * 1e-3);
      ASSERT_NEAR(begun.Measure().p1, whole.Measure().p1, 1e-3) << k;
      ASSERT_NEAR(begun.Measure().p2, whole.Measure().p2, 1e-3) << k;
      ASSERT_NEAR(begun.Measure().motor_angle, whole.Measure().motor_angle, 1e-5) << k;
      ASSERT_NEAR(begun.Measure().arm_angle, whole.Measure().arm_angle, 1e-7) << k;
    }
  }
}

// Tests that a measured pressure below the accumulator's, which noise may make, begins at the accumulator's,
// and that a state that cannot be is refused.
TEST(StartedActuatorTest, BeginsWhereItCan) {
  StartState start{};
  start[kP1] = -5;
  start[kP2] = 100;
  const StartedActuator low(Table1Model(), {}, start, 1);
  EXPECT_EQ(low.Measure().p1, testing::Table1().p_3);
  EXPECT_EQ(low.Measure().p2, 100);
  start[kArmAngle] = 1.5;  // V_1 would be negative
  EXPECT_THROW(StartedActuator(Table1Model(), {}, start, 1), ModelError);
  ActuatorOptions options;
  options.relative_tolerance = 0;
  start[kArmAngle] = 0;
  EXPECT_THROW(StartedActuator(Table1Model(), options, start, 1), ModelError);
}

}  // namespace
}  // namespace hydro::model
