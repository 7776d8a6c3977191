#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/input_error.h"
#include "model/coupled_arm.h"
#include "sim/limb/joint.h"
#include "tests/sim/limb/limb_fixture.h"

namespace hydro::limb {
namespace {

using ::testing::HasSubstr;
using testing::JointRecord;
using testing::SmallLimb;

settings::LimbConfig TwoLinks() {
  settings::LimbConfig config = SmallLimb({"hip", "knee"});
  config.arm.emplace();
  config.arm->gravity = 386.1;
  config.arm->links = {{.mass = 0.02, .length = 15, .centre = 7, .inertia = 0.4},
                       {.mass = 0.012, .length = 13, .centre = 6, .inertia = 0.2}};
  for (auto& joint : config.joints) joint.config.noise = {};
  return config;
}

int RunToEnd(Limb& limb) {
  if (limb.Begin()) {
    while (limb.StepLockstep()) {
    }
  }
  return limb.End({});
}

// Tests that the joints of a limb with an arm are those of the model's coupled arm under the voltages that
// the limb drove, to the bit.
TEST(JointedArmTest, IsTheModelsCoupledArm) {
  const settings::LimbConfig config = TwoLinks();
  Limb limb(config, {});
  JointRecord hip(*limb.joints()[0]), knee(*limb.joints()[1]);
  ASSERT_EQ(RunToEnd(limb), 0);

  model::ArmJoint joint{.model = config.joints[0].config.model.description};
  const double tolerance = joint.options.relative_tolerance;
  joint.options = plant::ActuatorOptionsOf(config.joints[0].config);
  joint.options.relative_tolerance = tolerance;
  model::CoupledArm arm(*config.arm, {joint, joint});
  ASSERT_EQ(hip.states.size(), 101U);
  ASSERT_EQ(knee.states.size(), 101U);
  for (size_t tick = 1; tick < hip.states.size(); ++tick) {
    arm.Advance(std::vector{hip.states[tick].voltage, knee.states[tick].voltage},
                static_cast<double>(tick) / 1000);
    EXPECT_EQ(arm.Measure(0).arm_angle, hip.states[tick].arm_angle);
    EXPECT_EQ(arm.Measure(1).arm_angle, knee.states[tick].arm_angle);
    EXPECT_EQ(arm.Measure(1).p1, knee.states[tick].p1);
  }
  EXPECT_LT(knee.states.back().arm_angle, -1e-5);  // it moves
}

// Tests that what one joint does moves the other one, and that it does not without an arm.
TEST(JointedArmTest, JointsFeelEachOther) {
  for (const bool coupled : {true, false}) {
    std::vector<double> angles;
    for (const double step : {0.05, -0.05}) {
      settings::LimbConfig config = TwoLinks();
      if (!coupled) config.arm.reset();
      config.joints[1].config.reference.trajectory.steps = {{0.01, step}};
      Limb limb(config, {});
      JointRecord hip(*limb.joints()[0]);
      EXPECT_EQ(RunToEnd(limb), 0);
      angles.push_back(hip.states.back().arm_angle);
    }
    EXPECT_EQ(angles[0] != angles[1], coupled);
  }
}

// Tests that a joint that has ended is at zero volts, and still part of the arm that the others move.
TEST(JointedArmTest, EndedJointStaysInTheArm) {
  settings::LimbConfig config = TwoLinks();
  config.limb.on_joint_fault = settings::OnJointFault::kOthersGoOn;
  config.joints[0].config.limits.motor_speed_rad_s = 0.5;
  Limb limb(config, {});
  JointRecord hip(*limb.joints()[0]), knee(*limb.joints()[1]);
  EXPECT_EQ(RunToEnd(limb), 1);
  EXPECT_LT(hip.states.back().tick, 100);
  EXPECT_EQ(knee.states.back().tick, 100);
  EXPECT_NE(knee.states.back().arm_angle, knee.states[50].arm_angle);
}

// Tests that an arm is not divided among processes.
TEST(JointedArmTest, IsNotDivided) {
  try {
    Limb limb(TwoLinks(), {.joints = {"hip"}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--joints: found some of the joints of an [arm]"));
  }
}

}  // namespace
}  // namespace hydro::limb
