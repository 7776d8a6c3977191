// Tests that coupled actuators are the plain actuator where nothing couples, keep energy, hold still what is
// held, and fail by name.
#include "model/coupled_arm.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "model/arm/planar_arm.h"
#include "tests/model/arm/arms.h"
#include "tests/model/model_case.h"

namespace hydro::model {
namespace {

using testing::kFlexure;
using testing::RefusalOf;
using testing::Table1Model;

constexpr double kTick = 1e-3;

EffectDescription SealFriction(double coulomb) {
  return {"actuator.seal_friction", {{"coulomb", coulomb}, {"viscous", 5}}, {}};
}

// Reverses the pump and opens the valves.
double Voltage(int joint, int tick) {
  return (tick / 50 % 2 == 0 ? 3 : -3) + 4 * std::sin(0.02 * (joint + 1) * tick);
}

std::vector<ArmJoint> Joints(int n, const std::vector<EffectDescription>& effects = {}) {
  std::vector<ArmJoint> joints;
  for (int i = 0; i < n; ++i) {
    joints.push_back(
        {Table1Model(effects), {.arm_angle = i % 2 == 0 ? -0.1 : 0.15, .relative_tolerance = 1e-8}});
  }
  return joints;
}

ArmDescription Straight(int links) {
  ArmDescription arm{.gravity = 386.09};
  arm.links.assign(static_cast<size_t>(links), {.mass = 0.05, .length = 20, .centre = 10, .inertia = 1.7});
  return arm;
}

void AdvanceTo(CoupledArm* arm, int tick) {
  std::vector<double> voltages(static_cast<size_t>(arm->joints()));
  for (int i = 0; i < arm->joints(); ++i) voltages[static_cast<size_t>(i)] = Voltage(i, tick - 1);
  arm->Advance(voltages, tick * kTick);
}

// Runs an arm's first joint beside a plain actuator; the tolerances are those of angle (rad), speed (rad/s)
// and pressures (psi).
void ExpectLikeActuator(CoupledArm* arm, Actuator* actuator, double angle, double speed, double pressure) {
  double moved = 0;
  for (int tick = 1; tick <= 500; ++tick) {
    AdvanceTo(arm, tick);
    actuator->Advance(Voltage(0, tick - 1), tick * kTick);
    const Measurement a = arm->Measure(0);
    const Measurement b = actuator->Measure();
    ASSERT_NEAR(a.arm_angle, b.arm_angle, angle) << tick;
    ASSERT_NEAR(a.arm_speed, b.arm_speed, speed) << tick;
    ASSERT_NEAR(a.p1, b.p1, pressure) << tick;
    ASSERT_NEAR(a.p2, b.p2, pressure) << tick;
    moved = std::max(moved, std::abs(b.arm_angle + 0.1));
  }
  EXPECT_GT(moved, 5e-3) << "it has to move";
}

// Tests that one link is the actuator with J_a and mgl, through reversals of the pump and openings of the
// valves.
TEST(CoupledArm, OneLinkIsTheActuator) {
  CoupledArm arm(Straight(1), Joints(1));
  ModelDescription model = Table1Model();
  model.parameters.J_a = 1.7 + 0.05 * 100;
  model.parameters.mgl = 0.05 * 386.09 * 10;
  Actuator actuator(model, Joints(1)[0].options);
  ExpectLikeActuator(&arm, &actuator, 1e-9, 1e-6, 1e-3);
}

// Tests the same with a spring and friction between the actuator and its link.
TEST(CoupledArm, OneLinkWithEffectsIsTheActuator) {
  const std::vector<EffectDescription> effects = {kFlexure, SealFriction(20)};
  CoupledArm arm(Straight(1), Joints(1, effects));
  ModelDescription model = Table1Model(effects);
  model.parameters.J_a = 1.7 + 0.05 * 100;
  model.parameters.mgl = 0.05 * 386.09 * 10;
  Actuator actuator(model, Joints(1)[0].options);
  ExpectLikeActuator(&arm, &actuator, 2e-7, 2e-4, 0.1);
}

// Tests that behind a joint that is locked straight, two links are one: the actuator with the inertia and
// gravity of both.
TEST(CoupledArm, LockedJointMakesOneLinkOfTwo) {
  std::vector<ArmJoint> joints = Joints(2);
  joints[1].options.shaft = Shaft::kClamped;
  joints[1].options.arm_angle = 0;
  CoupledArm arm(Straight(2), joints);
  ModelDescription model = Table1Model();
  model.parameters.J_a = 2 * 1.7 + 0.05 * (10 * 10 + 30 * 30);
  model.parameters.mgl = 0.05 * 386.09 * (10 + 30);
  Actuator actuator(model, joints[0].options);
  ExpectLikeActuator(&arm, &actuator, 1e-8, 1e-5, 1e-2);
  EXPECT_EQ(arm.Measure(1).arm_angle, 0);
}

// Tests that the arm's energy is what its actuators have given it.
TEST(CoupledArm, EnergyIsTheActuatorsWork) {
  const ArmDescription description = testing::UnevenArm(3);
  const PlanarArm links(description);
  CoupledArm arm(description, Joints(3));
  const auto energy = [&] {
    std::vector<double> angles, speeds;
    for (int i = 0; i < 3; ++i) {
      angles.push_back(arm.Measure(i).arm_angle);
      speeds.push_back(arm.Measure(i).arm_speed);
    }
    return links.KineticEnergy(angles, speeds) + links.PotentialEnergy(angles);
  };
  const auto power = [&] {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += arm.ActuatorTorque(i) * arm.Measure(i).arm_speed;
    return sum;
  };
  const double start = energy();
  double work = 0, largest = 0;
  constexpr int kParts = 20;  // of a tick
  for (int tick = 0; tick < 200; ++tick) {
    const std::array<double, 3> voltages = {Voltage(0, tick), Voltage(1, tick), Voltage(2, tick)};
    for (int part = 0; part < kParts; ++part) {  // the trapezoid's error is of their second order
      const double before = power();
      arm.Advance(voltages, kTick * (tick + (part + 1.0) / kParts));
      work += 0.5 * (before + power()) * kTick / kParts;
    }
    largest = std::max(largest, std::abs(work));
    ASSERT_NEAR(energy() - start, work, 0.02) << tick;
  }
  EXPECT_GT(largest, 5) << "in-lbf";
}

// Tests that friction of its own holds a joint exactly still until what the others do to it is more than it
// holds.
TEST(CoupledArm, FrictionHoldsAgainstTheOthers) {
  const auto run = [](double coulomb) {
    std::vector<ArmJoint> joints = Joints(2);
    joints[1].model = Table1Model({SealFriction(coulomb)});
    joints[1].options.arm_angle = 0;
    ArmDescription description = Straight(2);
    description.gravity = 0;
    CoupledArm arm(description, joints);
    double moved = 0;
    for (int tick = 1; tick <= 300; ++tick) {
      arm.Advance(std::array<double, 2>{Voltage(0, tick - 1), 0}, tick * kTick);
      moved = std::max(moved, std::abs(arm.Measure(1).arm_angle));
    }
    EXPECT_GT(std::abs(arm.Measure(0).arm_angle + 0.1), 1e-3);
    return moved;
  };
  EXPECT_EQ(run(1e4), 0);
  EXPECT_GT(run(20), 1e-5);
}

// Tests that a joint held by friction leaves the others the motion that they have beside a locked one.
TEST(CoupledArm, HeldIsLikeLocked) {
  std::vector<ArmJoint> held = Joints(2), locked = Joints(2);
  held[1].model = Table1Model({SealFriction(1e5)});
  held[1].options.arm_angle = locked[1].options.arm_angle = 0.2;
  locked[1].options.shaft = Shaft::kClamped;
  CoupledArm a(Straight(2), held), b(Straight(2), locked);
  for (int tick = 1; tick <= 200; ++tick) {
    AdvanceTo(&a, tick);
    AdvanceTo(&b, tick);
    ASSERT_NEAR(a.Measure(0).arm_angle, b.Measure(0).arm_angle, 1e-8) << tick;
    ASSERT_NEAR(a.Measure(0).p1, b.Measure(0).p1, 1e-2) << tick;
  }
}

// Tests that one joint's motion moves another whose pump rests: the fluid of a pump that sticks is a spring.
TEST(CoupledArm, MotionOfOneMovesTheOther) {
  ArmDescription description = Straight(2);
  description.gravity = 0;
  CoupledArm arm(description, Joints(2));
  double swing = 0;
  for (int tick = 1; tick <= 100; ++tick) {
    arm.Advance(std::array<double, 2>{6, 0}, tick * kTick);
    swing = std::max(swing, std::abs(arm.ActuatorTorque(1)));
  }
  EXPECT_GT(swing, 10);  // in-lbf
}

// Tests that identical calls give identical bits.
TEST(CoupledArm, IdenticalCallsGiveIdenticalBits) {
  CoupledArm a(testing::UnevenArm(4), Joints(4)), b(testing::UnevenArm(4), Joints(4));
  for (int tick = 1; tick <= 200; ++tick) {
    AdvanceTo(&a, tick);
    AdvanceTo(&b, tick);
  }
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(a.Measure(i).arm_angle, b.Measure(i).arm_angle);
    EXPECT_EQ(a.Measure(i).motor_speed, b.Measure(i).motor_speed);
    EXPECT_EQ(a.Measure(i).p1, b.Measure(i).p1);
  }
  EXPECT_EQ(a.time(), 200 * kTick);
}

// Tests that what does not fit is refused, with the joint's number.
TEST(CoupledArm, RefusesByName) {
  EXPECT_EQ(RefusalOf([] { CoupledArm(Straight(3), Joints(2)); }),
            "found 2 joints for an arm of 3 links; allowed is one for each link");
  EXPECT_EQ(RefusalOf([] {
              std::vector<ArmJoint> joints = Joints(2);
              joints[1].options.shaft = Shaft::kDriven;
              CoupledArm(Straight(2), joints);
            }),
            "joint 2: a driven shaft needs a motion");
  EXPECT_EQ(RefusalOf([] {
              std::vector<ArmJoint> joints = Joints(2);
              joints[1].model.parameters.beta = 0;
              CoupledArm(Straight(2), joints);
            }).substr(0, 25),
            "joint 2: parameter beta =");
  EXPECT_EQ(RefusalOf([] { CoupledArm(Straight(1), Joints(1), {.steps_per_radian = 0}); }),
            "longest_step and steps_per_radian of a coupled arm must be above 0");
  CoupledArm arm(Straight(2), Joints(2));
  EXPECT_EQ(RefusalOf([&] { arm.Advance(std::array<double, 1>{0}, 1); }), "found 1 voltages for 2 joints");
  arm.Advance(std::array<double, 2>{0, 0}, 0.5);
  EXPECT_EQ(RefusalOf([&] {
              arm.Advance(std::array<double, 2>{0, 0}, 0.4);
            }),
            "cannot advance to t = 0.400000 s from t = 0.500000 s");
}

// Tests that a joint that leaves its stroke ends the run with an error that names it.
TEST(CoupledArm, NamesTheJointThatLeavesItsStroke) {
  CoupledArm arm(Straight(2), Joints(2));
  const std::string message = RefusalOf([&] { arm.Advance(std::array<double, 2>{0, 10}, 20); });
  EXPECT_EQ(message.substr(0, 9), "joint 2: ") << message;
}

}  // namespace
}  // namespace hydro::model
