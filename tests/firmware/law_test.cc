#include "firmware/law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "pressure_ctrl/law/pressure_law.h"
#include "tune/live/bumpless_transfer.h"

namespace hydro::firmware {
namespace {

// The law of the computer for the same numbers.
double Reference(const hydro_gains& gains, const hydro_law_input& input) {
  pressure_ctrl::PressureLawSettings settings;
  settings.gains = {gains.k_p, gains.k_v};
  settings.reference_feedforward = gains.reference_feedforward;
  settings.arm_speed_ratio = gains.arm_speed_ratio;
  pressure_ctrl::PressureLawInput numbers;
  numbers.pressure_ref = input.pressure_ref;
  numbers.p1 = input.p1;
  numbers.p2 = input.p2;
  numbers.motor_speed = input.motor_speed;
  numbers.arm_speed = input.arm_speed;
  return pressure_ctrl::UnlimitedPressureLaw(settings, numbers);
}

// What the law adds up, all with one sign: rounding is relative to that.
double Size(const hydro_gains& gains, const hydro_law_input& input) {
  const double arm = gains.arm_speed_ratio == 0 ? 0 : double{gains.arm_speed_ratio} * double{input.arm_speed};
  const double speed = std::fabs(double{input.motor_speed}) + std::fabs(arm);
  const double pressures = std::fabs(double{input.pressure_ref}) + std::fabs(double{input.p1}) +
                           std::fabs(double{input.p2}) + std::fabs(double{gains.k_v}) * speed;
  return std::fabs(double{gains.k_p}) * pressures +
         std::fabs(double{gains.reference_feedforward} * double{input.pressure_ref});
}

// Tests that a million random inputs give the voltages of the C++ law, to the rounding of single precision:
// no term passes through more than six roundings of 2^-24.
TEST(LawTest, GivesTheVoltagesOfTheComputersLaw) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> decades(-2, 2);
  const auto draw = [&](float scale) { return scale * std::pow(10.0F, decades(random)) * normal(random); };
  double worst = 0, largest = 0;
  for (int i = 0; i < 1000000; ++i) {
    const bool arm = i % 2 == 0;
    const hydro_gains gains{draw(0.13F), draw(8), draw(0.01F), arm ? draw(400) : 0};
    const hydro_law_input input{draw(500), draw(300), draw(300), draw(200), arm ? draw(1) : NAN};
    const double expected = Reference(gains, input);
    const double error = std::fabs(double{hydro_law(&gains, &input)} - expected);
    const double size = Size(gains, input);
    ASSERT_LE(error, 6 * 0x1p-24 * size) << "input " << i << ": " << expected << " V";
    worst = std::max(worst, error / size);
    largest = std::max(largest, std::fabs(expected));
  }
  EXPECT_GT(worst, 0x1p-25);  // it is single precision that was compared
  EXPECT_GT(largest, 1000);
}

// Tests the law by numbers worked out by hand: 0.1 ((300 - (150 - 50)) - 2 (30 - 10 * 1)) + 0.01 * 300 = 19.
TEST(LawTest, ByHand) {
  const hydro_gains gains{0.1F, 2, 0.01F, 10};
  const hydro_law_input input{300, 50, 150, 30, 1};
  EXPECT_FLOAT_EQ(hydro_law(&gains, &input), 19);
}

// Tests that a change of gains passes as it does on the computer, tick by tick, whenever the next one comes.
TEST(LawTest, TransferPassesLikeTheComputers) {
  std::mt19937 random(5);
  for (const uint32_t ticks : {0U, 1U, 7U, 500U}) {
    tuning::BumplessTransfer reference(ticks);
    hydro_transfer transfer{};
    int passing = 0;
    for (int64_t tick = 0; tick < 3000; ++tick) {
      hydro_transfer_pass(&transfer, 1);
      if (random() % 300 == 0) {
        const float before = static_cast<float>(random() % 1000), after = static_cast<float>(random() % 1000);
        reference.Begin(before, after, tick);
        hydro_transfer_begin(&transfer, before, after, ticks);
      }
      const double expected = reference.Offset(tick);
      ASSERT_NEAR(hydro_transfer_now(&transfer), expected, 1e-3) << ticks << " ticks, at " << tick;
      passing += expected != 0;
    }
    EXPECT_EQ(passing > 0, ticks > 0);
  }
}

// Tests that nothing is left when more ticks pass at once than there are.
TEST(LawTest, TransferOverMissedTicks) {
  hydro_transfer transfer{};
  hydro_transfer_begin(&transfer, 3, 1, 10);
  EXPECT_EQ(hydro_transfer_now(&transfer), 2);
  hydro_transfer_pass(&transfer, 5);
  EXPECT_EQ(hydro_transfer_now(&transfer), 1);
  hydro_transfer_pass(&transfer, 4000000000U);
  EXPECT_EQ(hydro_transfer_now(&transfer), 0);
}

// Tests what counts as finite, and that gains differ by any of the four.
TEST(LawTest, FiniteAndSame) {
  constexpr float kEndless = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(hydro_is_finite(0) && hydro_is_finite(-3e38F) && hydro_is_finite(1e-45F));
  EXPECT_FALSE(hydro_is_finite(NAN) || hydro_is_finite(kEndless) || hydro_is_finite(-kEndless));
  const hydro_gains gains{1, 2, 3, 4};
  EXPECT_TRUE(hydro_same_gains(&gains, &gains));
  EXPECT_TRUE(hydro_finite_gains(&gains));
  for (float hydro_gains::*member : {&hydro_gains::k_p, &hydro_gains::k_v,
                                     &hydro_gains::reference_feedforward, &hydro_gains::arm_speed_ratio}) {
    hydro_gains other = gains;
    other.*member = 5;
    EXPECT_FALSE(hydro_same_gains(&gains, &other));
    other.*member = NAN;
    EXPECT_FALSE(hydro_finite_gains(&other));
  }
}

}  // namespace
}  // namespace hydro::firmware
