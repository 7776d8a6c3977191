// The gap between a rig and one that lacks what is hidden in it: what other values and starts explain is
// none.
#include "tests/foreign_rig/gap.h"

#include <gtest/gtest.h>

#include "tests/foreign_rig/catalogue.h"
#include "tests/foreign_rig/size.h"

namespace foreign_rig {
namespace {

// Tests that multiples of a direction are explained whole, and what stands across it not at all.
TEST(Directions, TakeOffWhatTheySpan) {
  Directions directions;
  directions.Add({1, 1, 0, 0}, 0);
  directions.Add({1, 1, 0, 1e-9}, 1e-6);  // as good as the first
  directions.Add({0, 1, 1, 0}, 0);
  Series inside = {2, 5, 3, 0};
  directions.TakeOff(&inside);
  EXPECT_NEAR(RootMeanSquare(inside), 0, 1e-12);
  Series across = {1, -1, 1, 2};
  directions.TakeOff(&across);
  EXPECT_NEAR(across[0], 1, 1e-12);
  EXPECT_NEAR(across[3], 2, 1e-12);
}

// Tests that columns explain up to their limits and share what they both explain, also where they are alike
// or nothing.
TEST(Directions, LimitsAreKept) {
  Series y = {10, 4, 1};
  TakeOffWithin({{1, 0, 0}, {0, 2, 0}, {0, 0, 0}}, {3, 5, 1}, &y);
  EXPECT_NEAR(y[0], 7, 1e-9);
  EXPECT_NEAR(y[1], 0, 1e-9);
  EXPECT_EQ(y[2], 1);
  Series alike = {10, 0.001};
  TakeOffWithin({{1, 0}, {1, 1e-4}}, {3, 4}, &alike);
  EXPECT_NEAR(alike[0], 3, 1e-9);
  Series negative = {-10};
  TakeOffWithin({{1}}, {4}, &negative);
  EXPECT_NEAR(negative[0], -6, 1e-9);
}

class Gap : public ::testing::Test {
 protected:
  // Bypassed, clamped and free: a gap does not hang on one kind of run.
  Gap() : plans_(DrawPlans(5, 1.2, 0.3)), meter_({plans_[0], plans_[1], plans_[3]}, kNoise, 1.2) {}

  // Part of the gap that an effect keeps.
  double Kept(const Effects& effects) const {
    Rig rig = plain_;
    rig.effects = effects;
    const GapMeter::Parts parts = meter_.Beyond(rig, plain_);
    EXPECT_GT(parts.gap, 1);
    return parts.beyond / parts.gap;
  }

  static constexpr std::array<double, kChannels> kNoise = {0.3, 1e-3, 1e-4, 1.5, 1.5};
  const Rig plain_;
  const std::vector<Plan> plans_;
  const GapMeter meter_;
};

// Tests that a rig is no gap away from itself, and that values within what they are known to are none.
TEST_F(Gap, ValuesAreNone) {
  EXPECT_EQ(meter_.Between(plain_, plain_), 0);
  Rig other = plain_;
  other.values.bulk_modulus *= 1.01;
  const GapMeter::Parts parts = meter_.Beyond(other, plain_);
  EXPECT_LT(parts.beyond, 0.1 * parts.gap);
}

// Tests that a value much farther off than it is known to is left, less what is allowed.
TEST_F(Gap, ValuesHaveLimits) {
  Rig near = plain_, far = plain_;
  near.values.displacement *= 1.015;
  far.values.displacement *= 1.15;
  const GapMeter::Parts close = meter_.Beyond(near, plain_), wide = meter_.Beyond(far, plain_);
  EXPECT_LT(close.beyond, 0.1 * close.gap);
  EXPECT_GT(wide.beyond / wide.gap, 4 * close.beyond / close.gap);
  EXPECT_GT(wide.beyond, 10);
}

// Tests that an offset of both pressures is other starts and another supply pressure: nearly nothing is left.
// One between the sides is a torque that no start has.
TEST_F(Gap, EqualOffsetsAreOtherStarts) {
  Effects equal, opposed;
  equal.offset_1 = equal.offset_2 = 8;
  opposed.offset_1 = 20;
  opposed.offset_2 = -20;
  const double kept = Kept(equal);
  EXPECT_LT(kept, 0.15);
  EXPECT_GT(Kept(opposed), 2 * kept);
}

// Tests that other values take a part of a small gain and less of a large one: equations of scaled pressures
// are the same with scaled values, which are not known to be so far off.
TEST_F(Gap, GainIsPartlyOtherValues) {
  Effects small, large;
  small.gain = 0.015;
  large.gain = 0.2;
  const double kept = Kept(small);
  EXPECT_LT(kept, 0.3);
  EXPECT_GT(Kept(large), 1.3 * kept);
}

// Tests that friction of another kind stays to a good part: neither starts nor values have its form.
TEST_F(Gap, FrictionIsLeft) {
  Effects stribeck, once;
  stribeck.static_excess = 0.8;
  stribeck.stribeck_speed = 4;
  EXPECT_GT(Kept(stribeck), 0.2);
  once.cogging = 1.5;
  EXPECT_GT(Kept(once), 0.3);
}

// Tests that the size for a gap is found.
TEST_F(Gap, SizeIsFound) {
  const Sized sized = FindSize(meter_, plain_, 1e-4, 0.4, 8, [&](double size) {
    Rig rig = plain_;
    rig.effects.gain = size;
    return rig;
  });
  EXPECT_TRUE(sized.reached);
  EXPECT_NEAR(sized.parts.beyond, 8, 1.2);
}

}  // namespace
}  // namespace foreign_rig
