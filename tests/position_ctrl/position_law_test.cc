#include "position_ctrl/law/position_law.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydro::position_ctrl {
namespace {

PositionLawSettings Settings(bool derivative_on_error) {
  PositionLawSettings settings;
  settings.c1 = 100;
  settings.c2 = 3;
  settings.sample_interval = 0.005;
  settings.derivative_on_error = derivative_on_error;
  return settings;
}

// Tests eq. (17) as printed, the derivative on the error: dp_ref = -c1 e - c2/T (e - e_previous).
TEST(PositionLawTest, DerivativeOnErrorIsEquation17) {
  PositionLaw law(Settings(true));
  EXPECT_DOUBLE_EQ(law.Update(0.01, 0, 1), -100 * 0.01);  // no previous sample, no derivative
  EXPECT_DOUBLE_EQ(law.Update(0.02, 0, 1), -100 * 0.02 - 3 / 0.005 * 0.01);
  // A step of the reference kicks: e goes from 0.02 to 0.02 - 0.1.
  EXPECT_DOUBLE_EQ(law.Update(0.02, 0.1, 1), -100 * -0.08 - 3 / 0.005 * -0.1);
}

// Tests that with the derivative on the measurement a step of the reference causes no kick.
TEST(PositionLawTest, DerivativeOnMeasurementDoesNotKick) {
  PositionLaw law(Settings(false));
  law.Update(0.02, 0, 1);
  EXPECT_DOUBLE_EQ(law.Update(0.02, 0.1, 1), 100 * 0.08);
  EXPECT_DOUBLE_EQ(law.Update(0.03, 0.1, 1), 100 * 0.07 - 3 / 0.005 * 0.01);
}

// Tests that after missed samples the difference is divided by the time that really passed.
TEST(PositionLawTest, MissedSamplesStretchTheDifference) {
  PositionLaw law(Settings(false));
  law.Update(0, 0, 1);
  EXPECT_DOUBLE_EQ(law.Update(0.03, 0, 3), -100 * 0.03 - 3 / 0.015 * 0.03);
}

// Tests that Reset() forgets the previous sample.
TEST(PositionLawTest, ResetForgets) {
  PositionLaw law(Settings(true));
  law.Update(1, 0, 1);
  law.Reset();
  EXPECT_DOUBLE_EQ(law.Update(0.5, 0, 1), -50);
}

// Tests that the command stays within the limit on both sides.
TEST(PositionLawTest, LimitsTheCommand) {
  PositionLawSettings settings = Settings(true);
  settings.pressure_limit = 20;
  PositionLaw law(settings);
  EXPECT_EQ(law.Update(1, 0, 1), -20);
  EXPECT_EQ(law.Update(-1, 0, 1), 20);
}

// Tests the D/A converter: nearest of 2^bits levels, one level less on the positive side, no effect with 0
// bits.
TEST(QuantiseDacTest, RoundsToLevels) {
  EXPECT_EQ(QuantiseDac(123.456, 0, 100), 123.456);
  EXPECT_DOUBLE_EQ(QuantiseDac(10.1, 12, 2048), 10);
  EXPECT_DOUBLE_EQ(QuantiseDac(10.6, 12, 2048), 11);
  EXPECT_DOUBLE_EQ(QuantiseDac(-10.6, 12, 2048), -11);
  EXPECT_DOUBLE_EQ(QuantiseDac(5000, 12, 2048), 2047);
  EXPECT_DOUBLE_EQ(QuantiseDac(-5000, 12, 2048), -2048);
}

// Tests that the D/A's error within its range never exceeds half a level.
TEST(QuantiseDacTest, ErrorIsAtMostHalfALevel) {
  const double level = 2000.0 / 512;
  for (double value = -2000; value <= 2000 - level; value += 0.37) {
    EXPECT_LE(std::fabs(QuantiseDac(value, 10, 2000) - value), level / 2 + 1e-9) << value;
  }
}

}  // namespace
}  // namespace hydro::position_ctrl
