// What is known of base parameters before the runs speak.
#include "diagnose/fit/prior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

// The model with J and T_s free, and what is known of them.
diagnose::Hypothesis Known(double weight) {
  diagnose::Hypothesis hypothesis = WithFree(Table1With(), {"J", "T_s"});
  model::ModelDescription given = Table1With();
  given.uncertainty["T_s"] = 0.1;
  hypothesis.known = std::make_shared<diagnose::Knowledge>(diagnose::Knowledge{given, weight});
  return hypothesis;
}

// Tests that a weight counts squared standard deviations, of a logarithm or of the value, stated or by kind.
TEST(KnownBefore, WeighsByUncertainty) {
  const diagnose::Prior prior = diagnose::KnownBefore(Known(2));
  ASSERT_EQ(prior.weight.size(), 2u);
  EXPECT_DOUBLE_EQ(prior.centre[0], std::log(Table1().J));
  EXPECT_DOUBLE_EQ(prior.weight[0], 2 / (0.05 * 0.05));
  EXPECT_DOUBLE_EQ(prior.centre[1], Table1().T_s);
  EXPECT_DOUBLE_EQ(prior.weight[1], 2 / std::pow(0.1 * Table1().T_s, 2));
}

// Tests that the two sides of a cylinder are known as its mean is, and other numbers of the model's own
// effects as friction is; that what was found is not known at all.
TEST(KnownBefore, NumbersOfTheModelsOwnEffects) {
  const model::EffectDescription areas{"actuator.unequal_areas", {{"difference", 0.2}}, {}},
      bias{"amp.bias", {{"bias", 2}}, {}},
      asymmetry{"pump.friction_asymmetry", {{"coulomb", 3}, {"viscous", 0}}, {}};
  diagnose::Hypothesis hypothesis = Known(2);
  auto known = std::make_shared<diagnose::Knowledge>(*hypothesis.known);
  known->given.effects = {areas, bias};
  hypothesis.known = known;
  hypothesis.model.effects = {areas, bias, asymmetry};
  hypothesis.base.clear();
  hypothesis.effects = {areas.id, bias.id, asymmetry.id};
  const diagnose::Prior prior = diagnose::KnownBefore(hypothesis);
  ASSERT_EQ(prior.weight.size(), 4u);
  EXPECT_NEAR(prior.weight[0], 2 / (std::pow(0.01 * (1 - 0.04), 2) / 2), 1e-6);
  EXPECT_NEAR(prior.weight[1], 2 / (0.6 * 0.6), 1e-9);
  EXPECT_EQ(prior.weight[2], 0);
  EXPECT_EQ(prior.weight[3], 0);
}

// Tests that a fit weighs what the balances measured beside what was known, a third of it for what is wrong
// in all rows; that what they did not measure keeps its prior; and that nothing is added without a
// measurement.
TEST(KnownToAFit, WeighsWhatBalancesMeasured) {
  diagnose::Hypothesis hypothesis = Known(2);
  const diagnose::Prior before = diagnose::KnownBefore(hypothesis);
  EXPECT_EQ(diagnose::KnownToAFit(hypothesis).weight, before.weight);
  diagnose::MeasuredValues measured{Table1(), {{model::BasePlace("J"), 0.05}}};
  measured.values.J *= 1.2;
  hypothesis.measured = std::make_shared<const diagnose::MeasuredValues>(measured);
  const diagnose::Prior prior = diagnose::KnownToAFit(hypothesis);
  // Known to 5 % before, and measured to 5 %: one part and a third of one.
  EXPECT_NEAR(prior.weight[0], before.weight[0] * 4 / 3, 1e-9);
  EXPECT_NEAR(prior.centre[0], std::log(Table1().J) + std::log(1.2) / 4, 1e-12);
  EXPECT_EQ(prior.weight[1], before.weight[1]);
  EXPECT_EQ(prior.centre[1], before.centre[1]);
  hypothesis.known = nullptr;
  EXPECT_EQ(diagnose::KnownToAFit(hypothesis).weight, (std::vector<double>{0, 0}));
}

// Tests that only its order of magnitude is known of a value that is given as 0, and nothing without
// knowledge.
TEST(KnownBefore, LittleOfZero) {
  diagnose::Hypothesis hypothesis = WithFree(Table1With(), {"f"});
  EXPECT_EQ(diagnose::KnownBefore(hypothesis).weight, std::vector<double>{0});
  hypothesis.known = std::make_shared<diagnose::Knowledge>(diagnose::Knowledge{Table1With(), 2});
  ASSERT_EQ(Table1().f, 0);
  // Friction that takes all of the pump's torque.
  EXPECT_DOUBLE_EQ(diagnose::KnownBefore(hypothesis).weight.at(0), 2 / std::pow(Table1().D, 2));
}

// Tests that a fit follows the runs against weak knowledge and stays as given against strong knowledge.
TEST(KnownBefore, HoldsAFit) {
  model::ModelDescription truth = Table1With();
  truth.parameters.T_s *= 1.3;
  const std::vector<diagnose::RunData> runs = ClampedPair(truth, 0.4, 3);
  const auto fitted = [&](double weight) {
    const diagnose::Fitted fit = diagnose::Fit(Known(weight), PointersTo(runs), StartsOf(runs), {});
    EXPECT_TRUE(fit.ok());
    return fit.hypothesis.model.parameters.T_s / Table1().T_s;
  };
  EXPECT_NEAR(fitted(1e-6), 1.3, 0.02);
  EXPECT_NEAR(fitted(1e9), 1, 0.01);
}

}  // namespace
}  // namespace hydro::testing
