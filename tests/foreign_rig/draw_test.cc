#include "tests/foreign_rig/draw.h"

#include <gtest/gtest.h>

#include <cmath>

namespace foreign_rig {
namespace {

// Tests that a seed and a purpose give one stream, and that either changes it.
TEST(Draw, SeedAndPurposeDecide) {
  EXPECT_EQ(Draw(1, "a").Uniform(), Draw(1, "a").Uniform());
  EXPECT_NE(Draw(1, "a").Uniform(), Draw(2, "a").Uniform());
  EXPECT_NE(Draw(1, "a").Uniform(), Draw(1, "b").Uniform());
}

// Tests mean and spread, within four standard errors of 40,000 numbers.
TEST(Draw, HasTheStatedMoments) {
  Draw draw(3, "moments");
  constexpr int kCount = 40000;
  double uniform = 0, normal = 0, square = 0;
  for (int i = 0; i < kCount; ++i) {
    uniform += draw.Uniform() / kCount;
    const double z = draw.Normal();
    normal += z / kCount;
    square += z * z / kCount;
  }
  EXPECT_NEAR(uniform, 0.5, 4 * std::sqrt(1.0 / 12 / kCount));
  EXPECT_NEAR(normal, 0, 4 * std::sqrt(1.0 / kCount));
  EXPECT_NEAR(square, 1, 4 * std::sqrt(2.0 / kCount));
}

// Tests that ranges are kept.
TEST(Draw, KeepsRanges) {
  Draw draw(4, "ranges");
  for (int i = 0; i < 1000; ++i) {
    const double value = draw.LogBetween(2, 50);
    EXPECT_GT(value, 2);
    EXPECT_LT(value, 50);
    const int index = draw.Index(3);
    EXPECT_GE(index, 0);
    EXPECT_LE(index, 2);
  }
}

}  // namespace
}  // namespace foreign_rig
