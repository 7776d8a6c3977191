// Tests of balances over time: which can be formed, what the true model leaves, and what changes of it do.
#include "diagnose/balances/balance_series.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/balances/masks.h"
#include "model/terms/parameter_info.h"
#include "tests/diagnose/balances/clean_runs.h"
#include "tests/diagnose/prepare_run.h"

namespace hydro::testing {
namespace {

using diagnose::BalanceKind;
using diagnose::BaseSeries;
using diagnose::RunMotion;

RunMotion MotionOf(const CleanRun& how) {
  const model::ModelDescription machine = PlainMachine();
  return diagnose::MotionOf(diagnose::PrepareRun(Measure(machine, how), machine.parameters),
                            machine.parameters);
}

const RunMotion& Pressed() {
  static const RunMotion motion = MotionOf(RichRuns()[0]);
  return motion;
}

const BaseSeries& PressedBase() {
  static const BaseSeries base = SeriesOf(PlainMachine(), Pressed());
  return base;
}

const Eigen::VectorXd& Of(const diagnose::BalanceSeries& series, BalanceKind balance) {
  return series[static_cast<size_t>(balance)];
}

std::vector<BalanceKind> Formed(const RunMotion& run) {
  std::vector<BalanceKind> formed;
  for (const BalanceKind balance : diagnose::kAllBalances) {
    if (CanForm(run, balance)) formed.push_back(balance);
  }
  return formed;
}

model::ModelDescription With(const model::EffectDescription& effect) { return PlainMachine({effect}); }

// Tests which balances a run allows: what is missing never counts as 0.
TEST(BalanceSeries, FormedOfWhatWasMeasured) {
  using enum BalanceKind;
  EXPECT_THAT(Formed(Pressed()), ::testing::ElementsAre(kTorque, kFlow1, kFlow2, kLevel1, kLevel2));
  EXPECT_THAT(Formed(MotionOf(RichRuns()[3])), ::testing::ElementsAre(kTorque));
  const RunMotion free = MotionOf(RichRuns()[2]);
  EXPECT_TRUE(CanForm(free, kArm));
  RunMotion blind = Pressed();
  blind.pressures = false;
  EXPECT_THAT(Formed(blind), ::testing::IsEmpty());
  for (const BalanceKind balance : diagnose::kAllBalances)
    EXPECT_EQ(Of(PressedBase().left, balance).size() > 0, CanForm(Pressed(), balance));
}

// The norm of the series where the mask lets it say something.
double NormOf(const Eigen::VectorXd& series, const std::vector<uint8_t>& mask) {
  double square = 0;
  for (Eigen::Index i = 0; i < series.size(); ++i)
    square += mask[static_cast<size_t>(i)] == 0 ? series[i] * series[i] : 0;
  return std::sqrt(square);
}

// Tests that the true model leaves little of what a model with a wrong inertia and leakage leaves, where no
// valve is open.
TEST(BalanceSeries, TruthLeavesLittle) {
  model::ModelDescription wrong = PlainMachine();
  wrong.parameters.J *= 1.5;
  wrong.parameters.c_I *= 10;
  const BaseSeries other = SeriesOf(wrong, Pressed());
  const model::Parameters given = PlainMachine().parameters;
  const auto masks =
      MasksOf(Pressed(), PressedBase().left, diagnose::FindHeldPressure({Pressed()}, given), given);
  for (const BalanceKind balance : {BalanceKind::kTorque, BalanceKind::kFlow1, BalanceKind::kFlow2}) {
    const std::vector<uint8_t>& mask = masks[static_cast<size_t>(balance)];
    EXPECT_GT(NormOf(other.left[static_cast<size_t>(balance)], mask), 0.1);
    EXPECT_LT(NormOf(Of(PressedBase().left, balance), mask), 0.1 * NormOf(Of(other.left, balance), mask))
        << static_cast<int>(balance);
  }
}

// Tests that nothing is beyond the model itself, and that what another one leaves is what it leaves beyond.
TEST(BalanceSeries, BeyondIsTheDifference) {
  for (const Eigen::VectorXd& none : Beyond(PlainMachine(), Pressed(), PressedBase())) {
    if (none.size() == 0) continue;
    EXPECT_LT(none.cwiseAbs().maxCoeff(), 1e-9);
  }
  for (const model::EffectDescription& effect :
       {model::EffectDescription{"pump.quadratic_drag", {{"k", 1e-4}}, {}},
        model::EffectDescription{"amp.lag", {{"tau", 4e-3}}, {}}}) {
    const diagnose::BalanceSeries beyond = Beyond(With(effect), Pressed(), PressedBase());
    const BaseSeries whole = SeriesOf(With(effect), Pressed());
    const Eigen::VectorXd& torque = Of(beyond, BalanceKind::kTorque);
    EXPECT_GT(torque.norm(), 1) << effect.id;
    EXPECT_LT((Of(whole.left, BalanceKind::kTorque) - Of(PressedBase().left, BalanceKind::kTorque) - torque)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-6)
        << effect.id;
    EXPECT_EQ(Of(beyond, BalanceKind::kFlow1).cwiseAbs().maxCoeff(), 0) << effect.id;
  }
}

// Tests that drag changes the torque by k w |w|, at each instant.
TEST(BalanceSeries, DragIsItsEquation) {
  constexpr double kDrag = 1e-4;
  const diagnose::BalanceSeries beyond =
      Beyond(With({"pump.quadratic_drag", {{"k", kDrag}}, {}}), Pressed(), PressedBase());
  const Eigen::VectorXd& torque = Of(beyond, BalanceKind::kTorque);
  for (Eigen::Index i = 0; i < torque.size(); i += 20) {
    const double w = Pressed().at[static_cast<size_t>(i) * Pressed().stride].motor_speed;
    EXPECT_NEAR(std::abs(torque[i]), kDrag * w * w, 1e-6);
  }
}

// Tests that derivatives are what small changes do, and that there are none of what changes the motor's
// torque.
TEST(BalanceSeries, DerivativesAreSmallChanges) {
  for (const auto& [name, member] :
       {std::pair{"J", &model::Parameters::J}, std::pair{"b", &model::Parameters::b},
        std::pair{"c_I", &model::Parameters::c_I}}) {
    const std::vector<diagnose::BalanceSeries> rates =
        DerivativesOf(PlainMachine(), Pressed(), {{model::Unknown::Kind::kBase, model::BasePlace(name)}});
    ASSERT_EQ(rates.size(), 1u);
    model::ModelDescription moved = PlainMachine();
    const double by = 1e-3 * moved.parameters.*member;
    moved.parameters.*member += by;
    const diagnose::BalanceSeries beyond = Beyond(moved, Pressed(), PressedBase());
    for (const BalanceKind balance : {BalanceKind::kTorque, BalanceKind::kFlow1, BalanceKind::kFlow2}) {
      const Eigen::VectorXd &a = Of(beyond, balance), b = by * Of(rates[0], balance);
      EXPECT_LE((a - b).norm(), 1e-3 * b.norm() + 1e-9) << name << " " << static_cast<int>(balance);
    }
  }
  EXPECT_TRUE(
      DerivativesOf(PlainMachine(), Pressed(), {{model::Unknown::Kind::kBase, model::BasePlace("k_1")}})
          .empty());
}

// Tests that a lag of the amplifier remembers the command alone, and that drag, which remembers nothing, does
// not.
TEST(BalanceSeries, WhatRemembersTheCommand) {
  EXPECT_TRUE(DependsOnCommandAlone(With({"amp.lag", {{"tau", 4e-3}}, {}}), Pressed(), PressedBase()));
  EXPECT_FALSE(
      DependsOnCommandAlone(With({"pump.quadratic_drag", {{"k", 1e-4}}, {}}), Pressed(), PressedBase()));
}

// Tests that a wrong scale of the transducers reads a part of the pressures too much, and that nothing else
// errs.
TEST(BalanceSeries, ErrorsOfSensors) {
  const diagnose::SignalErrors none = ErrorsOf(PlainMachine(), Pressed());
  for (const std::vector<double>& of : none.of) EXPECT_TRUE(of.empty());
  const diagnose::SignalErrors gain =
      ErrorsOf(With({"sensor.pressure_gain", {{"gain", 0.05}}, {}}), Pressed());
  const std::vector<double>& p1 = gain.of[static_cast<size_t>(diagnose::GridChannel::kP1)];
  ASSERT_EQ(p1.size(), Pressed().size());
  for (size_t k = 0; k < p1.size(); k += 50) EXPECT_NEAR(p1[k], 0.05 * Pressed().at[k].p1, 1e-6);
  EXPECT_TRUE(gain.of[static_cast<size_t>(diagnose::GridChannel::kSpeed)].empty());
}

}  // namespace
}  // namespace hydro::testing
