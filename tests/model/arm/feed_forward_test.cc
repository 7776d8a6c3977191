// Tests that feed-forward tells a joint what its own model does not know, and nothing else.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "model/arm/arm_coupling.h"
#include "tests/model/arm/arms.h"

namespace hydro::model {
namespace {

// Tests that one link's own model knows everything.
TEST(FeedForward, OneLinkNeedsNone) {
  ArmDescription description{.gravity = 386.09};
  description.links = {{.mass = 0.05, .length = 20, .centre = 10, .inertia = 1.7}};
  const PlanarArm arm(description);
  std::array<Parameters, 1> joints;
  SetOwnLoads(arm, std::array{0.2}, joints);
  EXPECT_NEAR(joints[0].J_a, 1.7 + 0.05 * 100, 1e-12);
  EXPECT_NEAR(joints[0].mgl, 0.05 * 386.09 * 10, 1e-10);
  std::array<double, 1> torque;
  CouplingTorques(arm, joints, std::array{-0.5}, std::array{2.0}, std::array{30.0}, torque);
  EXPECT_NEAR(torque[0], 0, 1e-10);
}

// Tests two links by the textbook: while joint 1 moves and joint 2 rests where its own model was measured,
// joint 2 is told of M_12 alpha_1'' and of the centrifugal torque m_2 l_1 c_2 sin(alpha_2) alpha_1'^2.
TEST(FeedForward, TwoLinksByTheTextbook) {
  ArmDescription description;  // in a horizontal plane
  description.links = {{.mass = 0.06, .length = 22, .centre = 9, .inertia = 2.5},
                       {.mass = 0.04, .length = 17, .centre = 8, .inertia = 1.1}};
  const PlanarArm arm(description);
  const std::array<double, 2> angles = {0.1, 0.6};
  std::array<Parameters, 2> joints;
  SetOwnLoads(arm, angles, joints);
  std::array<double, 2> torques;
  const double a1 = 40, v1 = 3;
  CouplingTorques(arm, joints, angles, std::array{v1, 0.0}, std::array{a1, 0.0}, torques);
  const double lever = 0.04 * 22 * 8;
  const double m12 = 0.04 * 64 + 1.1 + lever * std::cos(0.6);
  EXPECT_NEAR(torques[0], 0, 1e-10);
  EXPECT_NEAR(torques[1], m12 * a1 + lever * std::sin(0.6) * v1 * v1, 1e-10);
}

}  // namespace
}  // namespace hydro::model
