// Tests that the model of a set of changes has the values of the machine that was measured.
#include "diagnose/evidence/estimated_model.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "model/formula/effect_formulas.h"
#include "tests/diagnose/evidence/scanned.h"

namespace hydro::testing {
namespace {

using diagnose::ChangeSet;
using diagnose::EstimatedModel;

// Longer than other tests' runs: estimates are to be within a few per cent.
constexpr double kSeconds = 2;

EstimatedModel ModelOf(const Scanned& scanned, const ChangeSet& set) {
  const std::optional<EstimatedModel> estimated =
      diagnose::ModelOf(scanned.runs, scanned.rows, set, diagnose::SetEvidence(scanned.rows).Fit(set));
  EXPECT_TRUE(estimated.has_value());
  return estimated.value_or(EstimatedModel{});
}

double ValueOf(const EstimatedModel& estimated, const std::string& effect, const std::string& name) {
  for (const model::EffectDescription& one : estimated.model.effects) {
    if (one.id == effect) return one.parameters.at(name);
  }
  ADD_FAILURE() << "no " << effect;
  return 0;
}

bool Moves(const EstimatedModel& estimated, const std::string& base) {
  return std::find(estimated.base.begin(), estimated.base.end(), model::BasePlace(base)) !=
         estimated.base.end();
}

// Tests that another drag and leakage are estimated without a change, and that runs of a clamped arm say
// nothing of the arm.
TEST(EstimatedModel, ValuesOfTheMachine) {
  model::ModelDescription truth = Table1With();
  truth.parameters.b *= 1.3;
  truth.parameters.J *= 1.1;
  const Scanned scanned(ClampedPair(truth, kSeconds, 3), {});
  const EstimatedModel estimated = ModelOf(scanned, {});
  const model::Parameters& p = estimated.model.parameters;
  EXPECT_NEAR(p.b, truth.parameters.b, 0.04 * truth.parameters.b);
  EXPECT_NEAR(p.J, truth.parameters.J, 0.03 * truth.parameters.J);
  EXPECT_NEAR(p.beta, truth.parameters.beta, 0.05 * truth.parameters.beta);
  EXPECT_TRUE(Moves(estimated, "b"));
  EXPECT_FALSE(Moves(estimated, "J_a"));
  // The estimate is as near as it says, and surer than the 30 % that were known before.
  const double deviation = estimated.deviation.at(model::BasePlace("b"));
  EXPECT_GT(deviation, 0.002);
  EXPECT_LT(deviation, 0.15);
  EXPECT_LT(std::abs(std::log(p.b / truth.parameters.b)), 3 * deviation);
  EXPECT_EQ(estimated.deviation.size(), estimated.base.size());
  EXPECT_EQ(p.J_a, truth.parameters.J_a);
  EXPECT_EQ(p.k_2, truth.parameters.k_2);
  EXPECT_THAT(estimated.changes, ::testing::IsEmpty());
  EXPECT_THAT(estimated.model.effects, ::testing::IsEmpty());
}

// Tests that what a short run hardly shows stays as it is given, though it acts there.
TEST(EstimatedModel, WhatIsNotShown) {
  const Scanned scanned(ClampedPair(Table1With(), 0.4, 10), {});
  const EstimatedModel estimated = ModelOf(scanned, {});
  EXPECT_TRUE(Moves(estimated, "c_E"));
  EXPECT_FALSE(Moves(estimated, "c_I"));
  // The yardstick of all flows may move.
  const model::Parameters& p = estimated.model.parameters;
  EXPECT_NEAR(p.c_I / Table1().c_I, p.D / Table1().D, 1e-9);
}

// Tests that a value far off is a change, and is estimated.
TEST(EstimatedModel, ValueFarOff) {
  model::ModelDescription truth = Table1With();
  truth.parameters.b *= 3;
  const Scanned scanned(ClampedPair(truth, kSeconds, 4), {});
  const EstimatedModel estimated = ModelOf(scanned, {"value.b"});
  EXPECT_NEAR(estimated.model.parameters.b, truth.parameters.b, 0.05 * truth.parameters.b);
  EXPECT_THAT(estimated.changes, ::testing::ElementsAre(diagnose::Change{"", {}, "b"}));
}

// Tests that an amount is estimated.
TEST(EstimatedModel, Amount) {
  constexpr double kDrag = 2e-4;
  const Scanned scanned(ClampedPair(Table1With({{"pump.quadratic_drag", {{"k", kDrag}}, {}}}), kSeconds, 5),
                        {"pump.quadratic_drag"});
  const EstimatedModel estimated = ModelOf(scanned, {"pump.quadratic_drag"});
  EXPECT_NEAR(ValueOf(estimated, "pump.quadratic_drag", "k"), kDrag, 0.1 * kDrag);
  EXPECT_THAT(estimated.changes, ::testing::ElementsAre(diagnose::Change{"pump.quadratic_drag", {}, ""}));
}

// Tests that the number of an effect that only the model file knows keeps to that effect's own bounds, not to
// those of a number that no catalogue has.
TEST(EstimatedModel, NumberOfAnEffectOfTheModelsOwn) {
  const model::ParameterInfo number{
      .name = "k", .unit = "in-lbf-s^2", .min = -1, .meaning = "gust", .example = 1e-4};
  const model::EffectInfo info{.id = "own.gust",
                               .summary = "wind that grows",
                               .equation = "T_load -= k w |w|",
                               .confused_with = "pump.quadratic_drag",
                               .parameters = {number}};
  model::EffectText text;
  text.equation = {"load -= k * motor_speed * abs(motor_speed)"};
  const auto formulas = std::make_shared<const model::EffectFormulas>(info, text);
  const auto with = [&](double k) {
    model::ModelDescription model = Table1With({{"own.gust", {{"k", k}}, {}}});
    model.effects.front().formulas = formulas;
    return model;
  };
  constexpr double kTrue = -2e-4, kGiven = -2.6e-4;
  const Scanned scanned(ClampedPair(with(kTrue), kSeconds, 12), {}, with(kGiven));
  EXPECT_NEAR(ValueOf(ModelOf(scanned, {}), "own.gust", "k"), kTrue, 0.3 * (kTrue - kGiven));
}

// Tests that an amount below 0 is estimated, too, where its least value is below 0 and not allowed.
TEST(EstimatedModel, AmountBelowNothing) {
  constexpr double kGain = -0.15;
  const Scanned scanned(
      ClampedPair(Table1With({{"sensor.pressure_gain", {{"gain", kGain}}, {}}}), kSeconds, 8),
      {"sensor.pressure_gain"});
  const EstimatedModel estimated = ModelOf(scanned, {"sensor.pressure_gain"});
  EXPECT_NEAR(ValueOf(estimated, "sensor.pressure_gain", "gain"), kGain, 0.3 * -kGain);
}

// Tests that an effect as a whole is moved along its shape, from its grid towards a truth between two points.
// The move is coarse: it goes by how large the effect is at all frequencies, and the balances show the low
// ones; simulation refines it.
TEST(EstimatedModel, ShapeBetweenTwo) {
  constexpr double kTau = 4.7e-3;
  const Scanned scanned(ClampedPair(Table1With({{"amp.lag", {{"tau", kTau}}, {}}}), kSeconds, 6),
                        {"amp.lag"});
  const EstimatedModel estimated = ModelOf(scanned, scanned.Best("amp.lag"));
  EXPECT_NEAR(ValueOf(estimated, "amp.lag", "tau"), kTau, 0.18 * kTau);
}

// Tests that a wave has the periods of its name, and its amplitude.
TEST(EstimatedModel, Wave) {
  const model::EffectDescription cogging = {
      "motor.cogging", {{"amplitude", 3}, {"periods", 9}, {"phase", 0.4}}, {}};
  Scanned scanned(ClampedPair(Table1With({cogging}), kSeconds, 7), {"motor.cogging"});
  scanned.rows = scanned.runs.MakeRows({9});
  const EstimatedModel estimated = ModelOf(scanned, {"motor.cogging|9"});
  EXPECT_EQ(ValueOf(estimated, "motor.cogging", "periods"), 9);
  EXPECT_NEAR(ValueOf(estimated, "motor.cogging", "amplitude"), 3, 0.3);
  EXPECT_NEAR(ValueOf(estimated, "motor.cogging", "phase"), 0.4, 0.15);
}

// Tests that values keep to their physical bounds, whatever the amounts are.
TEST(EstimatedModel, KeepsToBounds) {
  const Scanned scanned(ClampedPair(Table1With(), 1, 8), {"pump.quadratic_drag"});
  const ChangeSet set = {"pump.quadratic_drag"};
  for (const double far : {-1e3, 1e3}) {
    diagnose::SetFit fit = diagnose::SetEvidence(scanned.rows).Fit(set);
    fit.amounts.setConstant(far);
    const std::optional<EstimatedModel> estimated = diagnose::ModelOf(scanned.runs, scanned.rows, set, fit);
    ASSERT_TRUE(estimated.has_value());
    for (const size_t base : estimated->base) {
      const model::BaseParameter& parameter = model::BaseParameters()[base];
      const double value = estimated->model.parameters.*parameter.member;
      EXPECT_GE(value, parameter.info.min) << parameter.info.name;
      EXPECT_LE(value, parameter.info.max) << parameter.info.name;
    }
    EXPECT_GE(ValueOf(*estimated, "pump.quadratic_drag", "k"), 0);
  }
}

// Tests that there is no model of oil that creeps.
TEST(EstimatedModel, NothingOfCreep) {
  const Scanned scanned(ClampedPair(Table1With(), 1, 9), {});
  const diagnose::SetEvidence evidence(scanned.rows);
  size_t creeps = 0;
  for (const std::string& name : evidence.names()) {
    if (name.find("creep") == std::string::npos) continue;
    ++creeps;
    EXPECT_FALSE(diagnose::ModelOf(scanned.runs, scanned.rows, {name}, evidence.Fit({name})).has_value())
        << name;
  }
  EXPECT_GT(creeps, 0u);
}

}  // namespace
}  // namespace hydro::testing
