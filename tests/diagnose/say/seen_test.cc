// Tests what is seen of a balance: how much it lacks beyond noise, when, and what that depends on.
#include "diagnose/say/seen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>

#include "diagnose/say/variables.h"

namespace hydro::diagnose {
namespace {

constexpr size_t kSamples = 600;

// One and a half seconds of a disturbance f(x), with x sweeping from -10 to 10 and back, one block a sample;
// noise of 1.
template <class F>
std::vector<CurvePoint> Of(const F& f) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<CurvePoint> points;
  for (size_t k = 0; k < kSamples; ++k) {
    const double x = 10 * std::sin(0.021 * static_cast<double>(k));
    points.push_back({x, f(x) + normal(random), 1});
  }
  return points;
}

double ExplainedOf(const std::vector<CurvePoint>& points, bool line) {
  return Explained(points, FineBins(points), line);
}

// Tests that a line explains a linear disturbance fully, that nothing explains noise, and that bins but no
// line explain a step.
TEST(Explained, ShareOfTheVariance) {
  const std::vector<CurvePoint> line = Of([](double x) { return 2 * x; });
  EXPECT_GT(ExplainedOf(line, true), 0.97);
  EXPECT_LE(ExplainedOf(line, true), 1.02);
  const std::vector<CurvePoint> even = Of([](double x) { return std::abs(x) > 5 ? 6.0 : -6.0; });
  EXPECT_LT(ExplainedOf(even, true), 0.05);
  EXPECT_GT(ExplainedOf(even, false), 0.8);
  EXPECT_LT(ExplainedOf(Of([](double) { return 0.0; }), false), 0.5);
  // Nothing depends on a quantity that does not change.
  std::vector<CurvePoint> still = line;
  for (CurvePoint& point : still) point.at = 1;
  EXPECT_EQ(ExplainedOf(still, false), 0);
}

template <class F>
std::string Where(const F& f, const std::string& where = "") {
  const std::vector<CurvePoint> points = Of(f);
  Dependence dependence{{"motor_speed", "rad/s"}, Binned(points)};
  dependence.variable.where = where;
  dependence.explained = ExplainedOf(points, false);
  return WhereOf(dependence);
}

// Tests that the range with most of the energy is named: small values, large ones of either sign, or all.
TEST(Seen, RangeInWords) {
  const std::string near = Where([](double x) { return std::abs(x) < 2 ? 30.0 : 0.0; });
  EXPECT_EQ(near.rfind("|motor_speed| < ", 0), 0u) << near;
  const std::string high = Where([](double x) { return x > 8 ? 30 * (x - 8) : 0.0; });
  EXPECT_EQ(high.rfind("motor_speed > ", 0), 0u) << high;
  EXPECT_EQ(Where([](double x) { return x > 0 ? 10.0 : -10.0; }), "changes with the sign of motor_speed");
  EXPECT_EQ(Where([](double x) { return 40 + x; }), "changes with motor_speed");
  EXPECT_EQ(Where([](double x) { return 40 + x; }, "|voltage| > 8 V"), "|voltage| > 8 V");
  EXPECT_EQ(Where([](double) { return 10.0; }), "the same everywhere");
}

// Tests that the stretches with energy are found, at their times, and that noise has none.
TEST(Seen, Windows) {
  LackingRun run;
  run.motion.name = "square";
  run.motion.at.resize(kSamples);
  std::vector<Block> blocks;
  for (size_t k = 0; k < kSamples; ++k) {
    run.motion.at[k].time = 0.0025 * static_cast<double>(k);
    blocks.push_back({0, k, k + 1, 0.5, 1});
  }
  EXPECT_TRUE(WindowsOf(blocks, {run}).empty());
  for (size_t k = 100; k < 140; ++k) blocks[k].value = 20;
  for (size_t k = 400; k < 410; ++k) blocks[k].value = -15;
  const std::vector<Window> windows = WindowsOf(blocks, {run});
  ASSERT_EQ(windows.size(), 2u);
  EXPECT_EQ(windows[0].run, "square");
  EXPECT_NEAR(windows[0].from, 0.25, 1e-9);
  EXPECT_NEAR(windows[0].to, 0.35, 1e-9);
  EXPECT_NEAR(windows[1].from, 1.0, 1e-9);
  EXPECT_NEAR(windows[1].to, 1.025, 1e-9);
}

// A run whose pump lacks so much torque where the motor turns forward; noise of 0.5.
LackingRun Forward(double size) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const auto b = static_cast<size_t>(BalanceKind::kTorque);
  LackingRun run;
  run.motion.step = 1e-3;
  run.motion.pressures = true;
  run.motion.at.resize(kSamples);
  run.base.left[b].resize(kSamples);
  for (Eigen::VectorXd* series : {&run.noise[0][b], &run.noise[1][b]}) series->resize(kSamples);
  run.masks[b].assign(kSamples, 0);
  run.weights[b].setOnes(kSamples);
  for (size_t k = 0; k < kSamples; ++k) {
    const double t = 1e-3 * static_cast<double>(k);
    const double speed = 20 * std::sin(30 * t);
    run.motion.voltage.push_back(k < kSamples / 2 ? 10 : 2);
    model::KnownMotion& at = run.motion.at[k];
    at = {.time = t, .voltage = run.motion.voltage.back(), .motor_angle = -20 / 30.0 * std::cos(30 * t)};
    at.motor_speed = speed;
    at.p1 = 100;
    at.p2 = 100 + 200 * t;
    at.p2_rate = 200;
    const auto i = static_cast<Eigen::Index>(k);
    run.base.left[b][i] = -(speed > 0 ? size : 0) + 0.5 * normal(random);
    for (auto& draw : run.noise) draw[b][i] = 0.5 * normal(random);
  }
  return run;
}

// Tests that masked stretches count for nothing: blocks that are mostly masked are left out, and of others
// only the rest counts.
TEST(Blocks, RespectMasks) {
  LackingRun run = Forward(3);
  const auto b = static_cast<size_t>(BalanceKind::kTorque);
  for (size_t k = 100; k < 205; ++k) {
    run.masks[b][k] = 1;
    run.weights[b][static_cast<Eigen::Index>(k)] = 0;
    run.base.left[b][static_cast<Eigen::Index>(k)] = 1e6;
  }
  const std::vector<Block> blocks = BlocksOf({run}, BalanceKind::kTorque, 0.02);
  EXPECT_NEAR(static_cast<double>(blocks.size()), kSamples / 20 - 5, 1);
  for (const Block& block : blocks) EXPECT_LT(std::abs(block.value), 5) << block.first;
}

// Tests that of all the variables, the one that a balance really depends on explains most.
TEST(Variables, TheRightOneExplainsMost) {
  const std::vector<LackingRun> runs = {Forward(3)};
  const std::vector<Block> blocks = BlocksOf(runs, BalanceKind::kTorque, 0.004);
  std::vector<Variable> variables = MotionVariables(runs, BalanceKind::kTorque, {}, false);
  for (const Variable& variable : variables) {
    ASSERT_EQ(variable.values.size(), 1u) << variable.name;
    ASSERT_EQ(variable.values[0].size(), kSamples) << variable.name;
  }
  const std::vector<Dependence> ranked = Ranked(blocks, std::move(variables), runs, BalanceKind::kTorque);
  EXPECT_EQ(ranked.front().variable.name, "motor_speed");
  EXPECT_GT(ranked.front().explained, 0.8);
}

// Tests that pressures are not spoken of where none was measured.
TEST(Variables, NoPressuresOfABareMotor) {
  std::vector<LackingRun> runs = {Forward(3)};
  runs[0].motion.pressures = false;
  for (const Variable& variable : MotionVariables(runs, BalanceKind::kTorque, {}, true))
    EXPECT_FALSE(variable.unit.starts_with("psi")) << variable.name;
}

// Tests that variables carry the units of the model.
TEST(Variables, HaveTheModelsUnits) {
  const auto units = [](const UnitSystem& system) {
    std::map<std::string, std::string> found;
    for (const Variable& variable : MotionVariables({Forward(3)}, BalanceKind::kFlow1, system, false))
      found[variable.name] = variable.unit;
    return found;
  };
  EXPECT_EQ(units({}).at("p1 rate"), "psi/s");
  EXPECT_EQ(units(kSiUnits).at("p1 rate"), "Pa/s");
  EXPECT_EQ(units(kSiUnits).at("p2 - p1"), "Pa");
  EXPECT_EQ(units({"mm", "N", true}).at("arm_speed"), "mm/s");
  EXPECT_EQ(units({"mm", "N", true}).at("motor_speed"), "rad/s");
}

// Tests what is offered: waves of a turn only on request, none for the arm; limits of the voltage with their
// places.
TEST(Variables, WhatIsOffered) {
  const std::vector<LackingRun> runs = {Forward(3)};
  EXPECT_EQ(MotionVariables(runs, BalanceKind::kFlow1, {}, true).size(),
            MotionVariables(runs, BalanceKind::kFlow1, {}, false).size() + 48);
  EXPECT_EQ(MotionVariables(runs, BalanceKind::kArm, {}, true).size(),
            MotionVariables(runs, BalanceKind::kArm, {}, false).size());
  const std::vector<Variable> commands = CommandVariables(runs);
  ASSERT_EQ(commands.size(), 11u);
  EXPECT_EQ(commands[1].where, "|voltage| > 5 V");
  EXPECT_TRUE(commands[1].line);
  EXPECT_NEAR(commands[1].values[0].front(), 5, 1e-9);  // of 10 V
  EXPECT_NEAR(commands[1].values[0].back(), 0, 1e-9);   // of 2 V
  // The rate of p2 - p1 is 200 psi/s.
  const std::vector<Variable> late = LateVariables(runs, BalanceKind::kTorque, {});
  ASSERT_EQ(late.size(), 1u);
  EXPECT_NEAR(late[0].values[0][100], 200, 1e-6);
  EXPECT_TRUE(LateVariables(runs, BalanceKind::kArm, {}).empty());
}

// Tests that what is lacking is seen over what it depends on, and that nothing is seen in noise or where
// there is no balance.
TEST(Seen, WhatIsLacking) {
  const Seen seen = LookAt({Forward(3), Forward(3)}, BalanceKind::kTorque, {});
  EXPECT_GT(seen.energy, 1000);
  ASSERT_FALSE(seen.ranked.empty());
  EXPECT_EQ(seen.ranked.front().variable.name, "motor_speed");
  EXPECT_GT(seen.ranked.front().explained, 0.8);
  EXPECT_EQ(LookAt({Forward(0)}, BalanceKind::kTorque, {}).energy, 0);
  EXPECT_TRUE(LookAt({Forward(3)}, BalanceKind::kFlow1, {}).when.empty());
}

}  // namespace
}  // namespace hydro::diagnose
