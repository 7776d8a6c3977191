#include "tune/design/held_input.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydro::design {
namespace {

// Tests that the transition of a double integrator with a decaying third state is that of its closed form.
TEST(HeldInput, ClosedForm) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 3);
  A(0, 1) = 1;
  A(2, 2) = -4;
  const Eigen::Vector3d B(0, 2, 8);
  const double t = 0.3;
  const HeldInput held = TransitionOver(A, B, t);
  Eigen::Matrix3d states;
  states << 1, t, 0, 0, 1, 0, 0, 0, std::exp(-4 * t);
  EXPECT_TRUE(held.states.isApprox(states, 1e-12)) << held.states;
  EXPECT_TRUE(held.input.isApprox(Eigen::Vector3d(t * t, 2 * t, 2 * (1 - std::exp(-4 * t))), 1e-12))
      << held.input;
}

// Tests that a state on which nothing depends goes, then the one that only it depended on, and one that never
// moves.
TEST(HeldInput, StatesThatMatter) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(5, 5);
  A(1, 0) = 1;  // 0 drives 1, the output
  A(1, 2) = 3;  // 2 never moves, and drives 1
  A(3, 0) = 1;  // 0 drives 3, which drives 4, on which nothing depends
  A(4, 3) = 1;
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(5, 1);
  B(0, 0) = 1;
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(1, 5);
  C(0, 1) = 1;
  EXPECT_EQ(StatesThatMatter(A, B, C), (std::vector<Eigen::Index>{0, 1}));
}

}  // namespace
}  // namespace hydro::design
