// Tests that each joint's own inertia and load describe the whole arm's motion.
#include "model/arm/arm_coupling.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/model/arm/arms.h"

namespace hydro::model {
namespace {

JointCoupling Moving(int n) {
  JointCoupling at(n);
  for (int i = 0; i < n; ++i) {
    at.angle[i] = 0.5 * std::sin(1.0 + i);
    at.speed[i] = 1.5 * std::cos(2.0 * i);
    at.torque[i] = 500 * std::sin(2.0 + 3 * i);
    at.torque_rate[i] = 9000 * std::cos(1.0 + 5 * i);
  }
  return at;
}

Eigen::MatrixXd Mass(const PlanarArm& arm, const JointCoupling& at) {
  Eigen::MatrixXd matrix(arm.links(), arm.links());
  arm.MassMatrix(arm.PoseAt(at.angle), {matrix.data(), static_cast<size_t>(matrix.size())});
  return matrix;
}

// Tests that the torques of the accelerations found are the torques given, that the same holds for their
// rates, and that inertia is 1/(M^-1)_ii.
TEST(ArmCoupling, DescribesTheWholeArm) {
  const PlanarArm arm(testing::UnevenArm(5));
  ArmCoupling coupling(arm);
  JointCoupling at = Moving(5);
  coupling.FindAccelerations(&at);
  coupling.FindLoads(&at);
  std::vector<double> torques(5), rates(5);
  arm.JointTorques(at.angle, at.speed, at.acceleration, torques);
  arm.JointTorqueRates(arm.PoseAt(at.angle), at.speed, at.acceleration, at.jerk, rates);
  const Eigen::MatrixXd inverse = Mass(arm, at).inverse();
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(torques[i], at.torque[i], 1e-9 * 500);
    EXPECT_NEAR(rates[i], at.torque_rate[i], 1e-9 * 9000);
    EXPECT_NEAR(at.inertia[i], 1 / inverse(i, i), 1e-10 * at.inertia[i]);
    EXPECT_NEAR(at.inertia[i] * at.acceleration[i], at.torque[i] + at.load[i], 1e-9 * 500);
    EXPECT_NEAR(at.inertia[i] * at.jerk[i], at.torque_rate[i] + at.load_rate[i], 1e-9 * 9000);
  }
}

// Tests that a held joint rests, that its load is what holds it, reversed, and that the rest moves as an arm
// whose two links there are one rigid body.
TEST(ArmCoupling, HeldJointIsRigid) {
  const PlanarArm arm(testing::UnevenArm(3));
  ArmCoupling coupling(arm);
  JointCoupling at = Moving(3);
  at.speed[1] = 0;
  at.held[1] = true;
  coupling.FindAccelerations(&at);
  coupling.FindLoads(&at);
  EXPECT_EQ(at.acceleration[1], 0);
  EXPECT_EQ(at.jerk[1], 0);
  std::vector<double> torques(3);
  arm.JointTorques(at.angle, at.speed, at.acceleration, torques);
  EXPECT_NEAR(torques[0], at.torque[0], 1e-9 * 500);
  EXPECT_NEAR(torques[2], at.torque[2], 1e-9 * 500);
  EXPECT_NEAR(torques[1], -at.load[1], 1e-9 * 500);
  EXPECT_GT(std::abs(at.load[1]), 1) << "a case without load shows nothing";

  const Eigen::MatrixXd mass = Mass(arm, at);
  Eigen::Matrix2d rigid;
  rigid << mass(0, 0), mass(0, 2), mass(2, 0), mass(2, 2);
  EXPECT_NEAR(at.inertia[0], 1 / rigid.inverse()(0, 0), 1e-10 * at.inertia[0]);
  EXPECT_NEAR(at.inertia[2], 1 / rigid.inverse()(1, 1), 1e-10 * at.inertia[2]);
  // Once free it would be as in an arm without held joints.
  EXPECT_NEAR(at.inertia[1], 1 / mass.inverse()(1, 1), 1e-10 * at.inertia[1]);
}

}  // namespace
}  // namespace hydro::model
