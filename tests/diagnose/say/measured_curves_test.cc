// Tests that the balances show the curves of the machine: its friction, its leakage, its load.
#include "diagnose/say/measured_curves.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using diagnose::MeasuredCurve;

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

// Tests that friction over speed is measured as it is: the found model's curve lies in the band, the given one's does not.
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

// Tests that leakage from side 2 to side 1 grows with p2 - p1 as the rig's does, and that the given model's is its own.
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

// Tests that the arm's load over its angle is measured in free runs, and that there is none where the arm is held.
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

}  // namespace
}  // namespace hydro::testing
