#include "tune/design/configured_laws.h"

#include <gtest/gtest.h>

#include "tests/settings/texts.h"

namespace hydro::design {
namespace {

// Tests that gains are derived from natural frequency and damping ratio, or taken as they are.
TEST(ConfiguredLaws, DerivesOrTakesTheGains) {
  const auto derived = settings::Parsed(settings::kConfigText);
  const auto law = PressureLawSettingsFor(derived);
  const auto gains = pressure_ctrl::DerivePressureGains(derived.model.description.parameters, 0, 150, 0.5, 2);
  EXPECT_EQ(law.gains.k_p, gains.k_p);
  EXPECT_EQ(law.gains.k_v, gains.k_v);
  EXPECT_EQ(law.voltage_limit, 10);  // T_pmax/k_1

  const auto given = settings::Parsed(settings::Replaced(
      settings::kConfigText, "natural_frequency_rad_s = 150\ndamping_ratio = 0.5", "k_p = 0.01\nk_v = 7"));
  EXPECT_EQ(PressureLawSettingsFor(given).gains.k_p, 0.01);
  EXPECT_EQ(PressureLawSettingsFor(given).gains.k_v, 7);
}

TEST(ConfiguredLaws, NamesTheKeyWhereNoGainsFollow) {
  const auto slow = settings::Parsed(settings::Replaced(
      settings::kConfigText, "natural_frequency_rad_s = 150", "natural_frequency_rad_s = 1"));
  EXPECT_THAT(
      settings::InputErrorOf([&] { PressureLawSettingsFor(slow); }),
      ::testing::HasSubstr("stack.toml: pressure.natural_frequency_rad_s: natural frequency: found 1"));
}

TEST(ConfiguredLaws, TakesTheArmsTorqueAsALimitOfPressure) {
  auto config = settings::Parsed(settings::kConfigText);
  config.limits.arm_torque_in_lbf = 368;
  const auto law = PositionLawSettingsFor(config);
  EXPECT_EQ(law.pressure_limit, 100);  // k_2 = 3.68 in-lbf/psi
  EXPECT_EQ(law.c1, 10500);
  EXPECT_EQ(law.sample_interval, config.position.sample_interval_s);
}

TEST(ConfiguredLaws, MakesABrakingCurveWhereOneIsConfigured) {
  EXPECT_FALSE(BrakingCurveFor(settings::Parsed(settings::kConfigText)));
  const auto config =
      settings::Parsed(settings::Replaced(settings::kConfigText, "c2 = 350", "c2 = 350\nbraking_rad_s2 = 3") +
                       "[limits]\nmotor_speed_rad_s = 628\n");
  const auto curve = BrakingCurveFor(config);
  ASSERT_TRUE(curve);
  EXPECT_DOUBLE_EQ(curve->straight_within(), 3 / (2 * 30.0 * 30.0));
  EXPECT_NEAR(curve->Speed(100), 0.95 * 628 / 462.8, 1e-3);
}

TEST(ConfiguredLaws, RefusesABrakingCurveThatCannotBe) {
  using ::testing::HasSubstr;
  const auto error = [](const std::string& to) {
    return settings::InputErrorOf(
        [&] { settings::Parsed(settings::Replaced(settings::kConfigText, "c2 = 350", to)); });
  };
  EXPECT_THAT(error("c2 = 350\nbraking_rad_s2 = 3\nderivative = \"error\""),
              HasSubstr("position.braking: found it beside derivative"));
  EXPECT_THAT(error("braking = 3"), HasSubstr("c1 and c2 above 0"));
  EXPECT_THAT(error("c2 = 350\nbraking_rad_s2 = 0"), HasSubstr("position.braking"));
}

}  // namespace
}  // namespace hydro::design
