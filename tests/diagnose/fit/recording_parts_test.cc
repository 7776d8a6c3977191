// The parts of the check of recordings, each by itself: balances of signals, combinations, single runs, factors.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "diagnose/data/balance_rows.h"
#include "diagnose/data/signal_balances.h"
#include "diagnose/fit/arm_load.h"
#include "diagnose/fit/joint_mistakes.h"
#include "diagnose/fit/run_check.h"
#include "diagnose/fit/unknown_factor.h"
#include "diagnose/fit/unknown_findings.h"
#include "diagnose/fit/window_errors.h"
#include "maths/median.h"
#include "tests/diagnose/noisy_rig.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using Recording = runs::MeasuredRun;

const model::ModelDescription kGiven = {"Table 1", testing::Table1(), {}};

// A rig that lacks nothing: clamped, or with a free arm, under steps of both signs.
Recording Recorded(model::Shaft shaft, double mgl = 0) {
  testing::NoisyRig rig;
  rig.model = kGiven;
  rig.model.parameters.mgl = mgl;
  Recording run =
      rig.Record("run", shaft, 0, 1.5, false, [](double t) { return std::sin(9 * t) > 0 ? 3.0 : -2.0; })
          .measured;
  for (auto signal : {&Recording::voltage, &Recording::motor_speed, &Recording::motor_angle, &Recording::p1,
                      &Recording::p2}) {
    (run.*signal).source.column = "X";
  }
  return run;
}

void Multiply(std::vector<double>* values, double factor) {
  for (double& value : *values) value *= factor;
}

SignalBalances BalancesOf(const Recording& run, const std::vector<RecordingMistake>& possible) {
  return {kGiven.parameters, run, MovingWindows(run, 6), possible};
}

bool NeverUp() { return false; }

// Tests that an angle moves by the integral of its speed, segment by segment.
TEST(BalanceRows, SpeedIsTheRateOfTheAngle) {
  const std::vector<Recording> windows = MovingWindows(Recorded(model::Shaft::kClamped), 4);
  ASSERT_FALSE(windows.empty());
  double moved = 0, apart = 0;
  for (const auto& rows : RatesOfAngles(windows, &Recording::motor_angle, &Recording::motor_speed)) {
    for (const Eigen::VectorXd& row : rows) {
      ASSERT_EQ(row.size(), 2);
      moved += row.cwiseAbs().maxCoeff();
      apart += std::abs(std::abs(row[0]) - std::abs(row[1]));
    }
  }
  EXPECT_GT(moved, 0);
  EXPECT_LT(apart, 0.1 * moved);
}

// Tests that the balances close best with the numbers as they are, and that what undoes a mistake closes them again.
TEST(SignalBalances, CloseWithTheRightNumbers) {
  const Recording run = Recorded(model::Shaft::kClamped);
  const auto possible = PossibleMistakes(run);
  const double right = BalancesOf(run, possible).LeftOpen({});
  for (const auto& change :
       {+[](SignalFactors& f) { f.p1 = f.p2 = 14.5; }, +[](SignalFactors& f) { f.voltage = -1; },
        +[](SignalFactors& f) { f.motor_speed = 0.1; }, +[](SignalFactors& f) { f.exchanged = true; }}) {
    SignalFactors factors;
    change(factors);
    EXPECT_GT(BalancesOf(run, possible).LeftOpen(factors), right + 0.5);
  }
  Recording rpm = run;
  Multiply(&rpm.motor_speed.values, 30 / M_PI);
  const auto mistakes = PossibleMistakes(rpm);
  const auto is_rpm = [](const RecordingMistake& one) { return one.what == "motor_speed is in rpm"; };
  const auto mistake = std::find_if(mistakes.begin(), mistakes.end(), is_rpm);
  ASSERT_NE(mistake, mistakes.end());
  SignalFactors undone;
  AddFactors(*mistake, &undone);
  EXPECT_NEAR(undone.motor_speed, M_PI / 30, 1e-9);
  EXPECT_LT(BalancesOf(rpm, mistakes).LeftOpen(undone), BalancesOf(rpm, mistakes).LeftOpen({}) - 0.5);
}

// Tests that two mistakes together stand first among the combinations, and that a sound recording has none that helps.
TEST(JointMistakes, TwoTogether) {
  Recording run = Recorded(model::Shaft::kClamped);
  Multiply(&run.motor_speed.values, 30 / M_PI);
  Multiply(&run.p1.values, 1 / 14.5037738);
  Multiply(&run.p2.values, 1 / 14.5037738);
  const auto possible = PossibleMistakes(run);
  const auto joint = JointMistakes(BalancesOf(run, possible), possible, 20);
  ASSERT_FALSE(joint.empty());
  const auto has_both = [](const std::vector<RecordingMistake>& one) {
    const auto says = [&](const char* what) {
      return std::any_of(one.begin(), one.end(), [&](const auto& mistake) { return mistake.what == what; });
    };
    return one.size() == 2 && says("motor_speed is in rpm") && says("p1 and p2 are in bar");
  };
  EXPECT_TRUE(std::any_of(joint.begin(), joint.end(), has_both));
  for (const auto& one : joint) EXPECT_LE(one.size(), kMostMistakes);
  const Recording sound = Recorded(model::Shaft::kClamped);
  const auto none = JointMistakes(BalancesOf(sound, PossibleMistakes(sound)), PossibleMistakes(sound), 20);
  EXPECT_LT(none.size(), joint.size());
}

// Tests what one run says by itself: in order, or what explains it; and a factor that no unit has.
TEST(RunCheck, OneRun) {
  const Recording run = Recorded(model::Shaft::kClamped);
  const std::function<bool()> never = NeverUp;
  const RunCheck sound(kGiven, run, never);
  EXPECT_TRUE(sound.IsInOrder());
  EXPECT_TRUE(sound.Explanations().empty());
  Recording bar = run;
  for (auto signal : {&Recording::p1, &Recording::p2}) Multiply(&(bar.*signal).values, 1 / 14.5037738);
  const RunCheck wrong(kGiven, bar, never);
  EXPECT_FALSE(wrong.IsInOrder());
  EXPECT_GT(wrong.as_recorded(), kInOrder);
  const auto explanations = wrong.Explanations();
  ASSERT_FALSE(explanations.empty());
  EXPECT_EQ(explanations[0].mistakes[0].what, "p1 and p2 are in bar");
  EXPECT_TRUE(wrong.Try(explanations[0].mistakes).Explains());
  EXPECT_FALSE(wrong.Try({}).Explains());
  const std::function<bool()> at_once = [] { return true; };
  EXPECT_TRUE(RunCheck(kGiven, bar, at_once).Explanations().empty());
}

// Tests that a gain of 3.1 is found as a factor without a unit, and said of all runs when they agree.
TEST(UnknownFactors, AGain) {
  Recording run = Recorded(model::Shaft::kClamped);
  for (auto signal : {&Recording::p1, &Recording::p2}) Multiply(&(run.*signal).values, 3.1);
  const auto factors = UnknownFactors(BalancesOf(run, PossibleMistakes(run)), run);
  const auto of_pressures = [](const RecordingMistake& one) {
    return one.factors.front().first == &Recording::p1;
  };
  const auto found = std::find_if(factors.begin(), factors.end(), of_pressures);
  ASSERT_NE(found, factors.end());
  EXPECT_NEAR(std::log(found->factors.front().second), std::log(1 / 3.1), 0.35);
  const std::function<bool()> never = NeverUp;
  std::vector<std::optional<RunCheck>> checks(2);
  for (auto& check : checks) check.emplace(kGiven, run, never);
  const auto findings = UnknownFactorFindings(checks, 1);
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].mistakes, findings[1].mistakes);
  EXPECT_THAT(findings[0].mistakes[0].what, ::testing::HasSubstr("no known unit"));
}

// Tests that the weight which a window's motion needs is the rig's, whatever the model says.
TEST(ArmLoad, WeightFromTheMotion) {
  constexpr double kWeight = 60;  // in-lbf
  const Recording run = Recorded(model::Shaft::kFree, kWeight);
  const model::ModelDescription& weightless = kGiven;
  const std::vector<Recording> windows = MovingWindows(run, 4);
  ASSERT_FALSE(windows.empty());
  const auto loaded = WithLoadOf(weightless, windows.front());
  ASSERT_TRUE(loaded.has_value());
  EXPECT_NEAR(loaded->parameters.mgl, kWeight, 0.2 * kWeight);
  Recording blind = windows.front();
  blind.arm_angle = {};
  EXPECT_FALSE(WithLoadOf(weightless, blind).has_value());
}

// Tests medians of errors, and that a gain counts the signals that both have.
TEST(WindowErrors, Medians) {
  EXPECT_EQ(maths::Median({3, 1, 2}), 2);
  EXPECT_EQ(maths::Median({4, 3, 1, 2}), 3);
  PredictionErrors bad, good;
  bad.fill(std::nan(""));
  good.fill(std::nan(""));
  bad[0] = 100;
  good[0] = 1;
  EXPECT_NEAR(MedianBadness({bad, bad, good}), std::log(100.0), 1e-9);
  EXPECT_NEAR(Gain({bad, bad}, {good, good}), std::log(100.0), 1e-9);
}

}  // namespace
}  // namespace hydro::diagnose
