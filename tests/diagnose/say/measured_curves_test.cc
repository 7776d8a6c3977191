// Tests that the balances show the curves of the machine (its friction, its leakage, its load) and the terms
// of effects.
#include "diagnose/say/measured_curves.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using diagnose::MeasuredCurve;
using ::testing::IsEmpty;
using ::testing::Not;

const MeasuredCurve* Find(const std::vector<MeasuredCurve>& curves, const std::string& element) {
  const auto is_it = [&](const MeasuredCurve& curve) { return curve.element == element; };
  const auto found = std::find_if(curves.begin(), curves.end(), is_it);
  return found == curves.end() ? nullptr : &*found;
}

// Runs of the true machine, as a given model and the true one see them.
std::vector<MeasuredCurve> CurvesIn(const model::ModelDescription& truth,
                                    const model::ModelDescription& given,
                                    std::vector<diagnose::RunData> runs) {
  return diagnose::MeasuredCurves(given, truth, PointersTo(runs), 2);
}

void ExpectWhole(const MeasuredCurve& curve) {
  EXPECT_GE(curve.at.size(), 6u);
  EXPECT_TRUE(std::is_sorted(curve.at.begin(), curve.at.end()));
  for (const std::vector<double>* one : {&curve.measured, &curve.error, &curve.model, &curve.found}) {
    ASSERT_EQ(one->size(), curve.at.size());
    for (const double value : *one) EXPECT_TRUE(std::isfinite(value));
  }
}

// Tests that friction over speed is measured as it is: the found model's curve lies in the band, the given
// one's does not.
TEST(MeasuredCurves, FrictionOverSpeed) {
  model::ModelDescription given = Table1With();
  given.parameters.T_s = 3;
  const model::ModelDescription truth = Table1With({{"pump.quadratic_drag", {{"k", 4e-4}}, {}}});
  const auto curves = CurvesIn(truth, given, ClampedPair(truth, 3, 3));
  const MeasuredCurve* friction = Find(curves, "pump_friction");
  ASSERT_NE(friction, nullptr);
  EXPECT_EQ(friction->unit, "in-lbf");
  EXPECT_EQ(friction->against, "motor_speed");
  EXPECT_EQ(friction->against_unit, "rad/s");
  ExpectWhole(*friction);
  for (size_t i = 0; i < friction->at.size(); ++i) {
    const double speed = friction->at[i];
    EXPECT_NEAR(friction->measured[i], friction->found[i], 4 * friction->error[i] + 0.1) << speed;
    if (std::abs(speed) < 20) continue;
    const model::Parameters p = Table1();
    const double true_friction = std::copysign(p.T_s, speed) + p.b * speed + 4e-4 * speed * std::abs(speed);
    EXPECT_NEAR(friction->found[i], true_friction, 0.05 * std::abs(true_friction) + 0.1) << speed;
    EXPECT_NEAR(friction->model[i], std::copysign(3, speed) + p.b * speed, 0.1) << speed;
    EXPECT_GT(std::abs(friction->measured[i]), std::abs(friction->model[i]) + 5 * friction->error[i])
        << speed;
  }
}

// Tests that leakage from side 2 to side 1 grows with p2 - p1 as the rig's does, and that the given model's
// is its own.
TEST(MeasuredCurves, LeakageOverPressure) {
  model::ModelDescription truth = Table1With();
  truth.parameters.c_I = 4e-5;
  const auto curves = CurvesIn(truth, Table1With(), ClampedPair(truth, 3, 3));
  const MeasuredCurve* leakage = Find(curves, "cross_leakage");
  ASSERT_NE(leakage, nullptr);
  EXPECT_EQ(leakage->unit, "in^3/s");
  EXPECT_EQ(leakage->against, "p2 - p1");
  ExpectWhole(*leakage);
  for (size_t i = 0; i < leakage->at.size(); ++i) {
    const double dp = leakage->at[i];
    EXPECT_NEAR(leakage->found[i], 4e-5 * dp, 1e-9) << dp;
    EXPECT_NEAR(leakage->model[i], 1e-6 * dp, 1e-9) << dp;
    EXPECT_NEAR(leakage->measured[i], 4e-5 * dp, 4 * leakage->error[i] + 0.01) << dp;
  }
}

// Tests that the arm's load over its angle is measured in free runs, and that there is none where the arm is
// held.
TEST(MeasuredCurves, LoadOverAngle) {
  model::ModelDescription truth = Table1With(), given = Table1With();
  truth.parameters.mgl = 150;
  given.parameters.mgl = 100;
  const auto held = CurvesIn(truth, given, ClampedPair(truth, 1, 3));
  EXPECT_EQ(Find(held, "arm_load"), nullptr);
  std::vector<diagnose::RunData> runs;
  runs.push_back(SmallRun(truth, model::Shaft::kFree, false, 3, 2, 3));
  const auto curves = CurvesIn(truth, given, std::move(runs));
  const MeasuredCurve* load = Find(curves, "arm_load");
  ASSERT_NE(load, nullptr);
  EXPECT_EQ(load->against, "arm_angle");
  EXPECT_EQ(load->against_unit, "rad");
  ExpectWhole(*load);
  for (size_t i = 0; i < load->at.size(); ++i) {
    const double angle = load->at[i];
    EXPECT_NEAR(load->found[i], 150 * std::cos(angle), 2) << angle;
    EXPECT_NEAR(load->model[i] / load->found[i], 100.0 / 150, 1e-9) << angle;
    EXPECT_NEAR(load->measured[i], load->found[i], 4 * load->error[i] + 3) << angle;
  }
}

// Tests that what cannot be formed has no curve: without a pressure, a run has neither friction nor leakage.
TEST(MeasuredCurves, NoneWithoutTheSignals) {
  std::vector<diagnose::RunData> runs = ClampedPair(Table1With(), 0.5, 3);
  for (diagnose::RunData& run : runs) run.measured.p2.values.clear();
  EXPECT_TRUE(diagnose::MeasuredCurves(Table1With(), Table1With(), PointersTo(runs)).empty());
}

std::optional<MeasuredCurve> TermIn(const model::ModelDescription& truth, const std::string& effect) {
  const std::vector<diagnose::RunData> runs = ClampedPair(truth, 0.8, 3);
  return diagnose::TermOf(truth, effect, PointersTo(runs), 2);
}

// Tests that cogging is drawn over an angle that was measured, and over none where runs may begin anywhere.
TEST(TermOf, CoggingOverAMeasuredAngle) {
  const model::ModelDescription truth =
      Table1With({{"motor.cogging", {{"amplitude", 1}, {"periods", 6}, {"phase", 0.7}}, {}}});
  const auto term = TermIn(truth, "motor.cogging");
  ASSERT_TRUE(term.has_value());
  EXPECT_THAT(term->against, ::testing::StartsWith("motor_angle"));
  std::vector<diagnose::RunData> runs = ClampedPair(truth, 0.8, 3);
  for (diagnose::RunData& run : runs) run.measured.motor_angle = {};
  EXPECT_FALSE(diagnose::TermOf(truth, "motor.cogging", PointersTo(runs), 2).has_value());
}

// Tests that a drag is drawn as pump torque over motor speed: its own term is its equation, and what the runs
// lack without it follows that.
TEST(TermOf, ADragOverMotorSpeed) {
  constexpr double kDrag = 1e-3;
  const auto term = TermIn(Table1With({{"pump.quadratic_drag", {{"k", kDrag}}, {}}}), "pump.quadratic_drag");
  ASSERT_TRUE(term.has_value());
  EXPECT_EQ(term->balance, "pump_torque");
  EXPECT_EQ(term->unit, "in-lbf");
  EXPECT_EQ(term->against, "motor_speed");
  ASSERT_THAT(term->at, Not(IsEmpty()));
  double largest = 0;
  for (size_t i = 0; i < term->at.size(); ++i) {
    const double speed = term->at[i];
    largest = std::max(largest, std::abs(speed));
    // A step of the curve is a sixtieth of the range wide.
    EXPECT_NEAR(term->found[i], -kDrag * speed * std::abs(speed), 0.03 * kDrag * 1e4) << speed;
  }
  EXPECT_GT(largest, 50);
  for (size_t i = 0; i < term->at.size(); ++i) {
    const double speed = term->at[i];
    if (std::abs(speed) < 30) continue;
    EXPECT_LT(term->measured[i] * speed, 0) << "a drag acts against the motion";
  }
}

// Tests that a relief valve, which has switches, is drawn over a pressure: nothing below its setting, and the
// more flow out of that side the higher the pressure is above it.
TEST(TermOf, AReliefValveOverPressure) {
  const auto term =
      TermIn(Table1With({{"valve.relief", {{"set", 200}, {"conductance", 1e-3}}, {}}}), "valve.relief");
  ASSERT_TRUE(term.has_value());
  const bool first = term->balance == "flow_1";
  EXPECT_EQ(term->against, first ? "p1" : "p2");
  EXPECT_EQ(term->against_unit, "psi");
  for (size_t i = 0; i < term->at.size(); ++i) {
    const double expected = -1e-3 * std::max(0.0, term->at[i] - 200);
    EXPECT_NEAR(term->found[i], expected, 0.02) << term->at[i];
  }
  EXPECT_GT(term->at.back(), 250);
}

// Tests that what repeats within a turn is drawn over a wave of the motor's angle.
TEST(TermOf, CoggingOverTheMotorsAngle) {
  const auto term =
      TermIn(Table1With({{"motor.cogging", {{"amplitude", 2}, {"periods", 9.03}, {"phase", 0.4}}, {}}}),
             "motor.cogging");
  ASSERT_TRUE(term.has_value());
  EXPECT_EQ(term->against, "motor_angle, 9.03 periods a turn");
  ASSERT_GE(term->at.size(), 12u);
  const auto [low, high] = std::minmax_element(term->found.begin(), term->found.end());
  EXPECT_NEAR(*high, 2, 0.2);
  EXPECT_NEAR(*low, -2, 0.2);
}

// Tests that effects that act through time, and effects that the model does not have, have no term.
TEST(TermOf, NoneWhereNothingIsAdded) {
  EXPECT_FALSE(TermIn(Table1With({{"amp.lag", {{"tau", 0.005}}, {}}}), "amp.lag").has_value());
  EXPECT_FALSE(TermIn(Table1With(), "pump.stribeck").has_value());
}

}  // namespace
}  // namespace hydro::testing
