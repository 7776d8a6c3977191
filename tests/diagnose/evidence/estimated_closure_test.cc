// Tests that curves of the scan, and the effects that state them, say the same.
#include "diagnose/evidence/estimated_closure.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnose/balances/closure_elements.h"
#include "diagnose/evidence/estimated_model.h"
#include "tests/diagnose/balances/clean_runs.h"
#include "tests/diagnose/evidence/scanned.h"

namespace hydro::testing {
namespace {

using diagnose::BalanceKind;
using diagnose::ClosureElement;

std::vector<std::string> SetsOf(const std::vector<ClosureElement>& elements) {
  std::vector<std::string> sets;
  for (const ClosureElement& one : elements) sets.push_back(one.set);
  return sets;
}

const Scanned& WithDrag() {
  static const Scanned scanned(ClampedPair(Table1With({{"pump.quadratic_drag", {{"k", 3e-4}}, {}}}), 2, 11),
                               {});
  return scanned;
}

// Tests that a curve is tried where its variable was seen: the bypass shows the torque against the speed
// alone, a free arm also its own.
TEST(ClosureElements, ThoseThatTheRunsCanShow) {
  const Scanned clamped(ClampedPair(Table1With(), 0.5, 1), {});
  const std::vector<std::string> sets = SetsOf(ClosureElements(clamped.runs.setup(), clamped.runs.motions()));
  EXPECT_THAT(sets, ::testing::ElementsAre("closure.pump_torque(motor_speed)", "closure.pump_torque(p2 - p1)",
                                           "closure.cross_flow(p2 - p1)", "closure.outer_flow(p)"));
  std::vector<diagnose::RunData> bypass;
  bypass.push_back(SmallRun(Table1With(), model::Shaft::kClamped, true, 0.5, 3, 1));
  const Scanned one(std::move(bypass), {});
  EXPECT_THAT(SetsOf(ClosureElements(one.runs.setup(), one.runs.motions())),
              ::testing::ElementsAre("closure.pump_torque(motor_speed)"));
  const Scanned each(OneOfEach(Table1With(), 0.5, 1), {});
  EXPECT_THAT(SetsOf(ClosureElements(each.runs.setup(), each.runs.motions())),
              ::testing::IsSupersetOf({"closure.arm_torque(arm_angle)", "closure.cross_flow(arm_angle)"}));
}

// Tests where a value lies on a curve.
TEST(ClosureElements, Places) {
  ClosureElement odd;
  odd.low = -50;
  odd.high = 50;
  odd.odd = true;
  EXPECT_DOUBLE_EQ(odd.PlaceOf(25), 0.5);
  EXPECT_DOUBLE_EQ(odd.PlaceOf(-50), -1);
  ClosureElement even;
  even.low = 100;
  even.high = 300;
  EXPECT_DOUBLE_EQ(even.PlaceOf(150), 0.25);
}

// The mean square of the torque that the model leaves, where it says something.
double TorqueLeft(const model::ModelDescription& model, const Scanned& scanned, size_t run) {
  constexpr auto kTorque = static_cast<size_t>(BalanceKind::kTorque);
  const Eigen::VectorXd left = SeriesOf(model, scanned.runs.motions()[run]).left[kTorque];
  const std::vector<uint8_t>& mask = scanned.runs.masks()[run][kTorque];
  double square = 0, count = 0;
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    if (mask[static_cast<size_t>(i)] != 0) continue;
    square += left[i] * left[i];
    count += 1;
  }
  return square / count;
}

// Tests that a machine with an unknown drag leaves less of the torque balance with the estimated curve, and
// the values beside it, than without. The rest is smoothing, where friction turns: the truth leaves as much.
TEST(EstimatedClosure, LeavesLess) {
  const model::ModelDescription given = PlainMachine(),
                                truth = PlainMachine({{"pump.quadratic_drag", {{"k", 3e-4}}, {}}});
  const Scanned scanned(
      Prepared({Measure(truth, RichRuns()[0]), Measure(truth, RichRuns()[1])}, given.parameters), {}, given);
  const diagnose::ChangeSet set = {"closure.pump_torque(motor_speed)"};
  const std::optional<diagnose::EstimatedModel> with =
      ModelOf(scanned.runs, scanned.rows, set, diagnose::SetEvidence(scanned.rows).Fit(set));
  ASSERT_TRUE(with.has_value());
  ASSERT_EQ(with->model.effects.size(), 1u);
  EXPECT_EQ(with->model.effects[0].id, "closure.pump_torque");
  for (size_t r = 0; r < scanned.runs.motions().size(); ++r)
    EXPECT_LT(TorqueLeft(with->model, scanned, r), 0.15 * TorqueLeft(given, scanned, r)) << r;
  EXPECT_NEAR(TorqueLeft(with->model, scanned, 0), TorqueLeft(truth, scanned, 0), 0.1);
}

// Tests that the curve is that of the amounts: the effect does what the columns do, for each element.
TEST(EstimatedClosure, DoesWhatItsColumnsDo) {
  const Scanned& scanned = WithDrag();
  const diagnose::SetEvidence evidence(scanned.rows);
  for (const ClosureElement& element : ClosureElements(scanned.runs.setup(), scanned.runs.motions())) {
    diagnose::SetFit fit = evidence.Fit({element.set});
    fit.amounts.setZero();
    for (size_t i = 0; i < fit.columns.size(); ++i) {
      const std::string& name = scanned.rows.columns[static_cast<size_t>(fit.columns[i])].name;
      if (name == element.set + ":1") fit.amounts[static_cast<Eigen::Index>(i)] = 0.3;
      if (name == element.set + ":2") fit.amounts[static_cast<Eigen::Index>(i)] = -0.2;
    }
    const model::ModelDescription with = Table1With(ClosuresOf(scanned.runs, scanned.rows, element.set, fit));
    ASSERT_EQ(with.effects.size(), element.parts.size()) << element.set;
    const diagnose::RunMotion& motion = scanned.runs.motions()[0];
    const diagnose::BalanceSeries beyond = Beyond(with, motion, scanned.runs.base()[0]);
    for (const ClosureElement::Part& part : element.parts) {
      const Eigen::VectorXd& series = beyond[static_cast<size_t>(part.balance)];
      ASSERT_GT(series.size(), 0);
      EXPECT_GT(series.norm(), 0) << element.set;
      for (Eigen::Index i = 0; i < series.size(); i += 10) {
        const model::KnownMotion& at = motion.at[static_cast<size_t>(i) * motion.stride];
        const double value = part.variable == "motor_speed" ? at.motor_speed
                             : part.variable == "p2 - p1"   ? at.p2 - at.p1
                             : part.variable == "p1"        ? at.p1
                                                            : at.p2;
        const double place = element.PlaceOf(std::clamp(value, element.low, element.high));
        const double curve = element.unit * (0.3 * std::sin(std::numbers::pi * place) -
                                             0.2 * std::sin(2 * std::numbers::pi * place));
        EXPECT_NEAR(series[i], part.factor * curve, 0.02 * element.unit) << element.set;
      }
    }
  }
}

// Tests that what is no curve, and a curve without amounts, makes no effect.
TEST(EstimatedClosure, NothingWithoutAmounts) {
  const Scanned& scanned = WithDrag();
  const diagnose::SetFit fit = diagnose::SetEvidence(scanned.rows).Fit({});
  EXPECT_THAT(ClosuresOf(scanned.runs, scanned.rows, "closure.outer_flow(p)", fit), ::testing::IsEmpty());
  EXPECT_THAT(ClosuresOf(scanned.runs, scanned.rows, "closure.unheard_of(p)", fit), ::testing::IsEmpty());
}

}  // namespace
}  // namespace hydro::testing
