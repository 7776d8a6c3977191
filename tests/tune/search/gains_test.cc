#include "tune/search/gains.h"

#include <gtest/gtest.h>

#include "tests/tune/search/configs.h"
#include "tune/design/configured_laws.h"

namespace hydro::tune {
namespace {

TEST(Gains, OfAConfigurationLeaveItAsItIs) {
  const settings::StackConfig config = Retuned({"pressure.arm_speed_feedforward=false"});
  const Gains gains = GainsOf(config);
  EXPECT_EQ(gains.natural_frequency, 150);
  EXPECT_EQ(gains.c1, 10000);
  EXPECT_FALSE(With(config, gains).pressure.arm_speed_feedforward);
}

TEST(Gains, ChangeTheLawsAndSwitchTheFeedForwardsOn) {
  const settings::StackConfig config =
      Retuned({"pressure.arm_speed_feedforward=false", "pressure.reference_feedforward=0.001",
               "position.derivative=error"});
  const settings::StackConfig tuned =
      With(config, {.natural_frequency = 120, .damping_ratio = 0.7, .c1 = 5000, .c2 = 400});
  EXPECT_EQ(tuned.pressure.natural_frequency_rad_s, 120);
  EXPECT_EQ(design::PositionLawSettingsFor(tuned).c1, 5000);
  EXPECT_FALSE(design::PositionLawSettingsFor(tuned).derivative_on_error);
  EXPECT_GT(design::PressureLawSettingsFor(tuned).arm_speed_ratio, 400);
  EXPECT_NE(design::PressureLawSettingsFor(tuned).reference_feedforward, 0.001);
}

TEST(Gains, HaveABrakingCurveOrNone) {
  const settings::StackConfig config = Retuned({"position.braking=3"});
  EXPECT_EQ(GainsOf(config).deceleration, 3);
  EXPECT_EQ(With(config, GainsOf(config)).position.braking_rad_s2, 3);
  const Gains fixed = {.natural_frequency = 150, .damping_ratio = 0.5, .c1 = 1, .c2 = 1};
  EXPECT_FALSE(With(config, fixed).position.braking_rad_s2);
}

// Tests that k_p and k_v stay the way in which eq. (16) is given.
TEST(Gains, KeepTheFormOfThePressureLaw) {
  const settings::StackConfig config = Retuned({"pressure.k_p=0.1336", "pressure.k_v=8.39"});
  ASSERT_TRUE(config.pressure.k_p);
  EXPECT_NEAR(GainsOf(config).natural_frequency, 150, 0.2);
  EXPECT_NEAR(GainsOf(config).damping_ratio, 0.5, 0.001);
  const settings::StackConfig tuned =
      With(config, {.natural_frequency = 150, .damping_ratio = 0.5, .c1 = 1, .c2 = 1});
  EXPECT_NEAR(*tuned.pressure.k_p, 0.1336, 1e-4);
  EXPECT_FALSE(tuned.pressure.natural_frequency_rad_s);
  EXPECT_EQ(GainKeys(tuned).front().first, "pressure.k_p");
}

TEST(Gains, AreRoundedForPeople) {
  const auto keys = GainKeys(
      With(Retuned(), {.natural_frequency = 150, .damping_ratio = 0.5, .c1 = 12345.678, .c2 = 1.0 / 3}));
  const auto value = [&](const std::string& name) {
    for (const auto& [key, text] : keys) {
      if (key == name) return text;
    }
    return std::string("missing");
  };
  EXPECT_EQ(value("position.c1"), "12346");
  EXPECT_EQ(value("position.c2"), "0.33333");
  EXPECT_EQ(value("position.derivative"), "\"measurement\"");
  EXPECT_EQ(value("pressure.arm_speed_feedforward"), "true");
}

}  // namespace
}  // namespace hydro::tune
