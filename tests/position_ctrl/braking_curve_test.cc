#include <gtest/gtest.h>

#include <cmath>

#include "position_ctrl/law/position_law.h"

namespace hydro::position_ctrl {
namespace {

constexpr double kSlope = 20;
constexpr double kDeceleration = 3;

TEST(BrakingCurve, IsALineNearTheTargetAndAParabolaBeyond) {
  const BrakingCurve curve(kSlope, kDeceleration);
  const double end = kDeceleration / (2 * kSlope * kSlope);
  EXPECT_DOUBLE_EQ(curve.straight_within(), end);
  EXPECT_DOUBLE_EQ(curve.Speed(0.9 * end), 0.9 * end * kSlope);
  EXPECT_DOUBLE_EQ(curve.Speed(0.3), std::sqrt(2 * kDeceleration * 0.3) - kDeceleration / (2 * kSlope));
  EXPECT_EQ(curve.Speed(0), 0);
}

// Tests that line and parabola meet without a jump and with one slope, and that the curve is odd and rises.
TEST(BrakingCurve, IsSmoothAndOdd) {
  const BrakingCurve curve(kSlope, kDeceleration);
  const double end = curve.straight_within();
  const double h = 1e-6 * end;
  EXPECT_NEAR(curve.Speed(end + h), curve.Speed(end - h), 3 * h * kSlope);
  EXPECT_NEAR((curve.Speed(end + 2 * h) - curve.Speed(end + h)) / h, kSlope, 1e-3);
  double last = -1;
  for (double error = 0; error < 1; error += 0.001) {
    EXPECT_EQ(curve.Speed(-error), -curve.Speed(error));
    EXPECT_GT(curve.Speed(error), last);
    last = curve.Speed(error);
  }
}

// Tests that an arm which follows the curve's speed decelerates by no more than asked for: v dv/de.
TEST(BrakingCurve, AsksForNoMoreThanTheDeceleration) {
  const BrakingCurve curve(kSlope, kDeceleration);
  for (double error = 1e-4; error < 1; error *= 1.1) {
    const double h = 1e-5 * error;
    const double deceleration =
        curve.Speed(error) * (curve.Speed(error + h) - curve.Speed(error - h)) / (2 * h);
    EXPECT_LE(deceleration, kDeceleration * (1 + 1e-6)) << error;
  }
}

TEST(BrakingCurve, LimitsTheSpeed) {
  const BrakingCurve curve(kSlope, kDeceleration, 0.5);
  EXPECT_EQ(curve.Speed(1), 0.5);
  EXPECT_EQ(curve.Speed(-1), -0.5);
  EXPECT_LT(curve.Speed(0.01), 0.5);
}

// Tests that eq. (17) with the curve's reference asks for c2 (speed of the curve - measured speed), and that
// without a deceleration it is as it was.
TEST(BrakingCurve, GoesBeforeEquation17) {
  const PositionLawSettings settings = {.c1 = 20000, .c2 = 1000, .sample_interval = 0.005};
  const BrakingCurve curve(settings.c1 / settings.c2, kDeceleration);
  const BrakingCurve none(settings.c1 / settings.c2, std::numeric_limits<double>::infinity());
  PositionLaw law(settings);
  law.Update(0.099, 0, 1);
  const double speed = (0.1 - 0.099) / 0.005;
  EXPECT_NEAR(law.Update(0.1, curve.Reference(0.1, 0.4), 1), 1000 * (curve.Speed(0.3) - speed), 1e-6);
  EXPECT_NEAR(none.Reference(0.1, 0.4), 0.4, 1e-15);
}

}  // namespace
}  // namespace hydro::position_ctrl
