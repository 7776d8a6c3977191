#include "plant/driver/signal_conditioning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hydro::plant {
namespace {

// Tests that a converter's codes and volts are inverse to each other, that the ends are the ends, and that
// voltages beyond them, or NaN, cannot get out.
TEST(ConverterRangeTest, CodesAndVolts) {
  const ConverterRange range{0xffff, -10, 10};
  EXPECT_DOUBLE_EQ(range.Volts(0), -10);
  EXPECT_DOUBLE_EQ(range.Volts(0xffff), 10);
  EXPECT_EQ(range.Code(0), 0x8000u);
  for (uint32_t code = 0; code <= 0xffff; code += 0x101) EXPECT_EQ(range.Code(range.Volts(code)), code);
  EXPECT_EQ(range.Code(11), 0xffffu);
  EXPECT_EQ(range.Code(-INFINITY), 0u);
  EXPECT_EQ(range.Code(NAN), 0x8000u);
  const ConverterRange unipolar{4095, 0, 10};
  EXPECT_EQ(unipolar.Code(5), 2048u);
  EXPECT_EQ(unipolar.Code(-1), 0u);
}

// Tests a counter that turns across its wrap and back, in steps of every size that can be told from a wrap.
TEST(EncoderCountTest, FollowsThroughWraps) {
  for (const int64_t step : {1, 100, 4000, 16383}) {
    EncoderCount count(0xffff);
    int64_t truth = 0;
    EXPECT_EQ(count.Update(0), 0);
    const auto turn = [&](int64_t by) {
      truth += by;
      return count.Update(static_cast<uint32_t>(truth & 0xffff)) == truth;
    };
    for (int i = 0; i < 200; ++i) ASSERT_TRUE(turn(step)) << i;
    for (int i = 0; i < 400; ++i) ASSERT_TRUE(turn(-step)) << i;
    EXPECT_EQ(truth, -200 * step);
  }
}

// Tests that the first reading is signed: just below the wrap is just below zero.
TEST(EncoderCountTest, FirstReadingIsSigned) {
  EXPECT_EQ(EncoderCount(0xffffff).Update(0xffffff), -1);
  EXPECT_EQ(EncoderCount(0xffffff).Update(0x800000), -0x800000);
  EXPECT_EQ(EncoderCount(0xffffff).Update(0x7fffff), 0x7fffff);
  EXPECT_EQ(EncoderCount(0xffffffff).Update(0xfffffffe), -2);
}

// Tests that a jump of a quarter of the range or more is refused: it may have been a turn the other way.
TEST(EncoderCountTest, ToldFromAWrap) {
  EncoderCount count(0xffff);
  EXPECT_EQ(count.Update(100), 100);
  EXPECT_EQ(count.Update(100 + 0x3fff), 100 + 0x3fff);
  EXPECT_EQ(count.Update(100 + 0x3fff + 0x4000), std::nullopt);
}

// Tests the low pass against the step response of y' = 2 pi f (x - y), however the time is divided.
TEST(LowPassTest, StepResponse) {
  const double corner = 20;
  for (const double step : {1e-4, 1e-3, 7e-3}) {
    LowPass filter(corner);
    EXPECT_EQ(filter.Update(1, 0), 1) << "starts at its first input";
    double time = 0;
    double output = 1;
    for (int i = 0; i < 30; ++i) {
      output = filter.Update(3, step);
      time += step;
      EXPECT_NEAR(output, 3 - 2 * std::exp(-2 * std::numbers::pi * corner * time), 1e-12);
    }
  }
}

// Tests that 0 Hz means no filter, and that after NaN the next number counts as the first.
TEST(LowPassTest, NoneAndNaN) {
  LowPass none(0);
  EXPECT_EQ(none.Update(1, 0.001), 1);
  EXPECT_EQ(none.Update(5, 0.001), 5);
  LowPass filter(10);
  filter.Update(1, 0);
  EXPECT_TRUE(std::isnan(filter.Update(NAN, 0.001)));
  EXPECT_EQ(filter.Update(7, 0.001), 7);
}

// Tests rates over uneven times, 0 before there are two readings, and NaN beside NaN.
TEST(DerivativeTest, Rates) {
  Derivative rate;
  EXPECT_EQ(rate.Update(2, 0), 0);
  EXPECT_DOUBLE_EQ(rate.Update(3, 0.5), 2);
  EXPECT_DOUBLE_EQ(rate.Update(3, 0.001), 0);
  EXPECT_DOUBLE_EQ(rate.Update(2, 0.25), -4);
  EXPECT_DOUBLE_EQ(rate.Update(9, 0), -4) << "no time has passed";
  EXPECT_TRUE(std::isnan(rate.Update(NAN, 0.1)));
  EXPECT_EQ(rate.Update(5, 0.1), 0);
}

}  // namespace
}  // namespace hydro::plant
