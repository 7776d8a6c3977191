#include "tests/foreign_rig/fluid.h"

#include <gtest/gtest.h>

namespace foreign_rig {
namespace {

// Tests the oil's two data points (46 cSt at 40 degrees, 6.8 at 100) and the slope against a difference.
TEST(Fluid, ViscosityFollowsVogel) {
  EXPECT_DOUBLE_EQ(RelativeViscosity(40), 1);
  EXPECT_NEAR(46 * RelativeViscosity(100), 6.8, 0.1);
  const double change = (RelativeViscosity(40.01) - RelativeViscosity(39.99)) / 0.02;
  EXPECT_NEAR(ViscositySlope(40), change, 1e-6);
}

// Tests Henry's law at its ends and in the middle.
TEST(Fluid, AirDissolves) {
  EXPECT_DOUBLE_EQ(FreeAir(0.01, 0, 4000), 0.01);
  EXPECT_DOUBLE_EQ(FreeAir(0.01, 1000, 4000), 0.0075);
  EXPECT_DOUBLE_EQ(FreeAir(0.01, 5000, 4000), 0);
}

// Tests the compressibility against Boyle's law: the volume of the air is free * kAtmosphere / absolute
// pressure.
TEST(Fluid, AirIsIsothermal) {
  const double free = 0.02;
  const auto volume = [&](double p) { return free * kAtmosphere / (p + kAtmosphere); };
  for (const double p : {0.0, 100.0, 1500.0}) {
    const double slope = -(volume(p + 0.01) - volume(p - 0.01)) / 0.02;
    EXPECT_NEAR(AirCompressibility(free, p) / slope, 1, 1e-6) << p;
  }
}

// Tests a hose's slope at rest and its end value.
TEST(Fluid, HoseStiffensUpToAKnee) {
  EXPECT_DOUBLE_EQ(HoseModulus(2e5, 30, 800, 0), 2e5);
  EXPECT_NEAR((HoseModulus(2e5, 30, 800, 0.1) - 2e5) / 0.1, 30, 0.01);
  EXPECT_NEAR(HoseModulus(2e5, 30, 800, 1e5), 2e5 + 30 * 800, 1e-6);
}

}  // namespace
}  // namespace foreign_rig
