#include "base/maths/matrix_functions.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace hydro::maths {
namespace {

// Two unknowns that are as well known as in any unit, coupled to each other.
Eigen::Matrix2d Coupled(double first_unit, double second_unit) {
  const Eigen::Vector2d units(first_unit, second_unit);
  Eigen::Matrix2d A;
  A << 2, 1, 1, 3;
  return units.asDiagonal() * A * units.asDiagonal();
}

TEST(SolveScaled, HasTheSameSolutionInAnyUnits) {
  const Eigen::Vector2d right(3, 4);  // of the solution (1, 1)
  for (const double unit : {1.0, 1e-9, 1e12}) {
    const Eigen::Vector2d units(1, unit);
    const Eigen::VectorXd x = SolveScaled(Coupled(1, unit), units.asDiagonal() * right, 1e-12).col(0);
    EXPECT_NEAR(x[0], 1, 1e-9) << unit;
    EXPECT_NEAR(x[1] * unit, 1, 1e-9) << unit;
  }
}

TEST(SolveScaled, LeavesAtZeroWhatNothingShows) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  A.topLeftCorner<2, 2>() = Coupled(1, 1e6);
  const Eigen::Vector3d right(3, 4e6, 0);
  const Eigen::VectorXd x = SolveScaled(A, right, 1e-12).col(0);
  EXPECT_NEAR(x[0], 1, 1e-9);
  EXPECT_NEAR(x[1] * 1e6, 1, 1e-9);
  EXPECT_EQ(x[2], 0);
}

}  // namespace
}  // namespace hydro::maths
