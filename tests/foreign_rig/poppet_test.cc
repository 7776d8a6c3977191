#include "tests/foreign_rig/poppet.h"

#include <gtest/gtest.h>

namespace foreign_rig {
namespace {

constexpr Poppet kValve{500, 250, 0.1, 0.002};

// Tests that the poppet lifts over its range, from where it opens.
TEST(Poppet, LiftsOverItsRange) {
  EXPECT_EQ(RestingLift(kValve, 499), 0);
  EXPECT_DOUBLE_EQ(RestingLift(kValve, 625), 0.5);
  EXPECT_EQ(RestingLift(kValve, 800), 1);
}

// Tests the orifice's law: four times the pressure gives twice the flow; none flows back; it begins at 0.
TEST(Poppet, FlowsAsTheRoot) {
  EXPECT_DOUBLE_EQ(PoppetFlow(kValve, 1, 400), 2.0);
  EXPECT_DOUBLE_EQ(PoppetFlow(kValve, 0.5, 1600), 2.0);
  EXPECT_EQ(PoppetFlow(kValve, 1, -5), 0);
  EXPECT_EQ(PoppetFlow(kValve, 0, 400), 0);
  EXPECT_NEAR(PoppetFlow(kValve, 1, 1e-6), 0, 1e-6);
}

}  // namespace
}  // namespace foreign_rig
