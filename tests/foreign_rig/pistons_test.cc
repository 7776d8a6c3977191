#include "tests/foreign_rig/pistons.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace foreign_rig {
namespace {

// Sum of the half sines of the pistons on the pressure side, relative to its mean z/pi.
double SumOfPistons(int pistons, double angle) {
  double sum = 0;
  for (int k = 0; k < pistons; ++k) sum += std::max(0.0, std::sin(angle + 2 * M_PI * k / pistons));
  return sum * M_PI / pistons;
}

// Tests the closed form against the pistons themselves: same heights over a turn.
TEST(Pistons, ClosedFormIsTheSum) {
  for (const int pistons : {5, 7, 9}) {
    double top = 0, bottom = 10, sum_top = 0, sum_bottom = 10, mean = 0;
    for (int i = 0; i < 36000; ++i) {
      const double angle = 2 * M_PI * i / 36000;
      const double pulse = PistonPulse(pistons, angle);
      const double sum = SumOfPistons(pistons, angle);
      top = std::max(top, pulse);
      bottom = std::min(bottom, pulse);
      sum_top = std::max(sum_top, sum);
      sum_bottom = std::min(sum_bottom, sum);
      mean += pulse / 36000;
    }
    EXPECT_NEAR(top, sum_top, 1e-6);
    EXPECT_NEAR(bottom, sum_bottom, 1e-4);
    EXPECT_NEAR(mean, 1, 1e-6);
  }
}

// Tests that an odd number pulses twice a piston, with the stated first harmonic.
TEST(Pistons, PulseTwiceAPiston) {
  for (const int pistons : {5, 9}) {
    double at_once = 0, at_twice = 0;
    for (int i = 0; i < 36000; ++i) {
      const double angle = 2 * M_PI * i / 36000;
      const double pulse = PistonPulse(pistons, angle) / 18000;
      at_once += pulse * std::cos(pistons * angle);
      at_twice += pulse * std::cos(2 * pistons * angle);
    }
    EXPECT_NEAR(at_once, 0, 1e-6);
    EXPECT_NEAR(at_twice, PulseAmplitude(pistons), 1e-6);
  }
}

}  // namespace
}  // namespace foreign_rig
