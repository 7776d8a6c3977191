#include "base/did_you_mean.h"

#include <gtest/gtest.h>

namespace hydro {
namespace {

const std::vector<std::string> kNames = {"k_p", "k_v", "natural_frequency_rad_s", "damping_ratio", "rate_hz"};

// Tests that misspelt names, names in the wrong case and names without their unit find the right one.
TEST(DidYouMeanTest, FindsNearNames) {
  EXPECT_EQ(Nearest("kp", kNames), "k_p");
  EXPECT_EQ(Nearest("natural_frequency", kNames), "natural_frequency_rad_s");
  EXPECT_EQ(Nearest("natural_frequncy_rad_s", kNames), "natural_frequency_rad_s");
  EXPECT_EQ(Nearest("Damping_Ratio", kNames), "damping_ratio");
  EXPECT_EQ(DidYouMean("rate_Hz", kNames), ", did you mean \"rate_hz\"?");
}

// Tests that an unrelated word finds nothing.
TEST(DidYouMeanTest, FindsNothingFarAway) {
  EXPECT_EQ(Nearest("colour", kNames), "");
  EXPECT_EQ(Nearest("", kNames), "");
  EXPECT_EQ(Nearest(std::string(100000, 'k'), kNames), "");
  EXPECT_EQ(DidYouMean("x", {}), "");
}

}  // namespace
}  // namespace hydro
