#include "diagnose/search/confused.h"

#include <gtest/gtest.h>

namespace hydro::diagnose {
namespace {

// Tests that a lag and a delay of the amplifier are confused, either way round, and neither with itself nor with a parameter.
TEST(Confused, AsTheCatalogueSays) {
  const Change lag = {"amp.lag", {}, ""}, delay = {"amp.delay", {}, ""},
               leakage = {"pump.turbulent_leakage", {}, ""};
  EXPECT_TRUE(IsConfusedWith(lag, delay));
  EXPECT_TRUE(AreConfused(lag, delay));
  EXPECT_TRUE(AreConfused(delay, lag));
  EXPECT_FALSE(AreConfused(lag, lag));
  EXPECT_FALSE(AreConfused(lag, leakage));
  EXPECT_FALSE(AreConfused(lag, {"", {}, "b"}));
  EXPECT_FALSE(AreConfused({"", {}, "b"}, lag));
}

}  // namespace
}  // namespace hydro::diagnose
