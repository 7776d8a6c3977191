// Tests of sets of changes by name, and of their odds beforehand.
#include "diagnose/evidence/change_set.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydro::diagnose {
namespace {

// Tests that the change of a name is what stands before its variant.
TEST(ChangeSet, ChangeOfAVariant) {
  EXPECT_EQ(ChangeOf("pump.stribeck|0.03"), "pump.stribeck");
  EXPECT_EQ(ChangeOf("sensor.skew(p1)"), "sensor.skew(p1)");
  EXPECT_EQ(ChangesOf({"pump.stribeck|0.03", "amp.lag|0.004"}), (ChangeSet{"amp.lag", "pump.stribeck"}));
}

// Tests that other values are no missing terms, and that effects and curves are.
TEST(ChangeSet, MissingTerms) {
  EXPECT_TRUE(IsMissingTerm("amp.lag|0.004"));
  EXPECT_TRUE(IsMissingTerm("closure.outer_flow(p)"));
  EXPECT_FALSE(IsMissingTerm("value.b"));
  EXPECT_FALSE(IsMissingTerm("run.T_s"));
}

// Tests that sets stay sorted, and that a variant stands for its change.
TEST(ChangeSet, WithAndHas) {
  const ChangeSet set = WithChange(WithChange({}, "value.b"), "amp.lag|0.004");
  EXPECT_EQ(set, (ChangeSet{"amp.lag|0.004", "value.b"}));
  EXPECT_TRUE(HasChange(set, "amp.lag"));
  EXPECT_TRUE(HasChange(set, "amp.lag|0.008"));
  EXPECT_FALSE(HasChange(set, "amp.delay"));
  EXPECT_FALSE(HasChange({}, "amp.lag"));
}

// Tests that nothing is missing at even odds, that variants share the odds of their change, and that a curve
// is less probable than an effect.
TEST(ChangeOdds, VariantsShareTheirOdds) {
  const ChangeOdds odds(
      {"amp.lag|1", "amp.lag|2", "amp.lag|3", "amp.bias", "closure.pump_torque(motor_speed)"});
  EXPECT_EQ(odds.LogOdds({}), 0);
  const double bias = odds.LogOdds({"amp.bias"});
  EXPECT_LT(bias, 0);
  EXPECT_NEAR(odds.LogOdds({"amp.lag|2"}), bias - std::log(3), 1e-12);
  EXPECT_NEAR(odds.LogOdds({"amp.bias", "amp.lag|2"}), 2 * bias - std::log(3), 1e-12);
  EXPECT_LT(odds.LogOdds({"closure.pump_torque(motor_speed)"}), bias - 2);
}

}  // namespace
}  // namespace hydro::diagnose
