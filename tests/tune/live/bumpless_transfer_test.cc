#include "tune/live/bumpless_transfer.h"

#include <gtest/gtest.h>

namespace hydro::tuning {
namespace {

// Tests that the output stays what it was, and that the difference passes in a straight line to nothing.
TEST(BumplessTransfer, PassesInAStraightLine) {
  BumplessTransfer transfer(10);
  EXPECT_EQ(transfer.Offset(99), 0);
  transfer.Begin(5, 3, 100);
  EXPECT_EQ(3 + transfer.Offset(100), 5);
  EXPECT_DOUBLE_EQ(transfer.Offset(105), 1);
  EXPECT_DOUBLE_EQ(transfer.Offset(109), 0.2);
  EXPECT_TRUE(transfer.passing());
  EXPECT_EQ(transfer.Offset(110), 0);
  EXPECT_FALSE(transfer.passing());
  EXPECT_EQ(transfer.Offset(105), 0) << "it has passed";
}

TEST(BumplessTransfer, AtOnceOrForgotten) {
  BumplessTransfer at_once(0);
  at_once.Begin(5, 3, 100);
  EXPECT_EQ(at_once.Offset(100), 0);
  BumplessTransfer forgotten(10);
  forgotten.Begin(5, 3, 100);
  forgotten.Forget();
  EXPECT_EQ(forgotten.Offset(101), 0);
}

}  // namespace
}  // namespace hydro::tuning
