// Tests that curves of many blocks are binned: narrow bins where there is much, honest errors, no bin over a
// step.
#include "diagnose/say/binned_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hydro::diagnose {
namespace {

// Friction with a step at rest, noise of 0.5; most of the time at low speeds.
std::vector<CurvePoint> Friction() {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::vector<CurvePoint> points;
  for (int k = 0; k < 2000; ++k) {
    const double speed = 100 * std::pow(std::sin(0.37 * k), 3);
    const double friction = std::copysign(4, speed) + 0.02 * speed;
    points.push_back({speed, friction + 0.5 * normal(random), 0.1, 0, friction});
  }
  return points;
}

// Tests that means lie on the curve to within their errors, that errors are those of the scatter, and that
// none lies between the two sides of the step.
TEST(Binned, MeansAndErrors) {
  const BinnedCurve curve = Binned(Friction());
  ASSERT_GE(curve.at.size(), 20u);
  for (size_t i = 0; i < curve.at.size(); ++i) {
    EXPECT_NEAR(curve.measured[i], curve.found[i], 4 * curve.error[i]) << curve.at[i];
    EXPECT_GT(std::abs(curve.measured[i]), 3.5) << curve.at[i];
    EXPECT_LT(curve.error[i], 0.5);
    EXPECT_GT(curve.error[i], 0.5 / std::sqrt(2000.0));
    if (i > 0) {
      EXPECT_GT(curve.at[i], curve.at[i - 1]);
      EXPECT_LT(curve.at[i] - curve.at[i - 1], 0.15 * 200);
    }
  }
  EXPECT_LT(curve.at.front(), -90);
  EXPECT_GT(curve.at.back(), 90);
}

// Tests that few points, or points at one place, make no curve.
TEST(Binned, NothingFromLittle) {
  EXPECT_TRUE(Binned({}).at.empty());
  EXPECT_TRUE(Binned({{1, 1, 1, 0, 0}, {2, 1, 1, 0, 0}}).at.empty());
  EXPECT_TRUE(Binned(std::vector<CurvePoint>(20, CurvePoint{3, 1, 1, 0, 0})).at.empty());
}

}  // namespace
}  // namespace hydro::diagnose
