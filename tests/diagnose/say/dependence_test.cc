#include "diagnose/say/dependence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>

#include "diagnose/say/seen.h"
#include "diagnose/say/variables.h"

namespace hydro::diagnose {
namespace {

constexpr size_t kSamples = 600;

// One and a half seconds of a disturbance f(x), with x sweeping from -10 to 10 and back, one block a sample;
// noise of 1.
struct Case {
  Blocks blocks;
  Variable variable;
  std::vector<double> averages;
};

template <class F>
Case Of(const F& f) {
  Case c;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  c.variable.name = "motor_speed";
  c.variable.unit = "rad/s";
  c.variable.values.resize(1);
  c.blocks.duration = 0.0025;
  for (size_t k = 0; k < kSamples; ++k) {
    const double x = 10 * std::sin(0.021 * static_cast<double>(k));
    c.variable.values[0].push_back(x);
    c.averages.push_back(x);
    c.blocks.blocks.push_back({0, k, k + 1, f(x) + normal(random), 1});
  }
  return c;
}

// Tests that a line explains a linear disturbance fully, that nothing explains noise, and that bins but no
// line explain a step.
TEST(Dependence, ExplainedShare) {
  const Case line = Of([](double x) { return 2 * x; });
  EXPECT_GT(Explained(line.blocks, line.averages, true), 0.97);
  EXPECT_LE(Explained(line.blocks, line.averages, true), 1.02);
  const Case even = Of([](double x) { return std::abs(x) > 5 ? 6.0 : -6.0; });
  EXPECT_LT(Explained(even.blocks, even.averages, true), 0.05);
  EXPECT_GT(Explained(even.blocks, even.averages, false), 0.8);
  const Case noise = Of([](double) { return 0.0; });
  EXPECT_LT(Explained(noise.blocks, noise.averages, false), 0.5);
  // Nothing depends on a quantity that does not change.
  EXPECT_EQ(Explained(line.blocks, std::vector<double>(kSamples, 1.0), false), 0);
}

// Tests that the table holds the function: bins in order, with means on it to within their errors.
TEST(Dependence, Table) {
  const Case c = Of([](double x) { return x * std::abs(x); });
  const MissingTerm table = TableOf(c.blocks, c.variable, c.averages);
  EXPECT_EQ(table.against, "motor_speed");
  EXPECT_EQ(table.against_unit, "rad/s");
  ASSERT_GE(table.at.size(), 8u);
  ASSERT_LE(table.at.size(), 12u);
  for (size_t i = 0; i < table.at.size(); ++i) {
    if (i > 0) {
      EXPECT_GT(table.at[i], table.at[i - 1]);
    }
    EXPECT_GT(table.error[i], 0);
    // The function is curved within a bin: its mean differs from its value at the mean.
    EXPECT_NEAR(table.mean[i], table.at[i] * std::abs(table.at[i]), 5 * table.error[i] + 3);
  }
  EXPECT_LT(table.mean.front(), -50);
  EXPECT_GT(table.mean.back(), 50);
}

// Tests that the range with most of the energy is named: small values, large ones of either sign, or all.
TEST(Dependence, RangeInWords) {
  const Case near = Of([](double x) { return std::abs(x) < 2 ? 30.0 : 0.0; });
  EXPECT_EQ(RangeOf(near.blocks, near.variable, near.averages).rfind("|motor_speed| < ", 0), 0u)
      << RangeOf(near.blocks, near.variable, near.averages);
  const Case high = Of([](double x) { return x > 8 ? 30 * (x - 8) : 0.0; });
  EXPECT_EQ(RangeOf(high.blocks, high.variable, high.averages).rfind("motor_speed > ", 0), 0u)
      << RangeOf(high.blocks, high.variable, high.averages);
  const Case sign = Of([](double x) { return x > 0 ? 10.0 : -10.0; });
  EXPECT_EQ(RangeOf(sign.blocks, sign.variable, sign.averages), "changes with the sign of motor_speed");
  Case given = Of([](double) { return 10.0; });
  EXPECT_EQ(RangeOf(given.blocks, given.variable, given.averages), "changes with motor_speed");
  given.variable.where = "|voltage| > 8 V";
  EXPECT_EQ(RangeOf(given.blocks, given.variable, given.averages), "|voltage| > 8 V");
}

// Tests that the stretches with energy are found, at their times, and that noise has none.
TEST(Dependence, Windows) {
  LackingRun run;
  run.motion.name = "square";
  run.motion.at.resize(kSamples);
  for (size_t k = 0; k < kSamples; ++k) run.motion.at[k].time = 0.0025 * static_cast<double>(k);
  Case c = Of([](double) { return 0.0; });
  for (Blocks::Block& block : c.blocks.blocks) block.value = 0.5;
  EXPECT_TRUE(WindowsOf(c.blocks, {run}).empty());
  for (size_t k = 100; k < 140; ++k) c.blocks.blocks[k].value = 20;
  for (size_t k = 400; k < 410; ++k) c.blocks.blocks[k].value = -15;
  const std::vector<Window> windows = WindowsOf(c.blocks, {run});
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
  run.motion.at.resize(kSamples);
  run.lacking[b].resize(kSamples);
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
    run.lacking[b][i] = (speed > 0 ? size : 0) + 0.5 * normal(random);
    for (auto& draw : run.noise) draw[b][i] = 0.5 * normal(random);
  }
  return run;
}

// Tests that what is lacking has energy, most of it in blocks no longer than it lasts, and that noise alone has none.
TEST(Blocks, Energy) {
  const Blocks found = LargestBlocks({Forward(3)}, BalanceKind::kTorque);
  EXPECT_GT(EnergyOf(found), 1000);
  EXPECT_LE(found.duration, 0.11);
  const Blocks none = LargestBlocks({Forward(0)}, BalanceKind::kTorque);
  EXPECT_LT(EnergyOf(none), 20);
  // A balance that cannot be formed has no blocks.
  EXPECT_TRUE(LargestBlocks({Forward(3)}, BalanceKind::kFlow1).blocks.empty());
}

// Tests that masked stretches count for nothing: blocks that are mostly masked are left out, and of others only the rest counts.
TEST(Blocks, RespectMasks) {
  LackingRun run = Forward(3);
  const auto b = static_cast<size_t>(BalanceKind::kTorque);
  for (size_t k = 100; k < 205; ++k) {
    run.masks[b][k] = 1;
    run.weights[b][static_cast<Eigen::Index>(k)] = 0;
    run.lacking[b][static_cast<Eigen::Index>(k)] = 1e6;
  }
  const Blocks blocks = BlocksOf({run}, BalanceKind::kTorque, 0.02);
  EXPECT_NEAR(static_cast<double>(blocks.blocks.size()), kSamples / 20 - 5, 1);
  for (const Blocks::Block& block : blocks.blocks) EXPECT_LT(std::abs(block.value), 5) << block.first;
}

// Tests that of all the variables, the one that a balance really depends on explains most.
TEST(Variables, TheRightOneExplainsMost) {
  const std::vector<LackingRun> runs = {Forward(3)};
  const Blocks blocks = BlocksOf(runs, BalanceKind::kTorque, 0.004);
  double most = 0;
  std::string name;
  for (const Variable& variable : MotionVariables(runs, BalanceKind::kTorque, {}, false)) {
    ASSERT_EQ(variable.values.size(), 1u) << variable.name;
    ASSERT_EQ(variable.values[0].size(), kSamples) << variable.name;
    const double share =
        Explained(blocks, Average(variable, blocks, runs, BalanceKind::kTorque), variable.linear_only);
    if (share > most) {
      most = share;
      name = variable.name;
    }
  }
  EXPECT_TRUE(name == "motor_speed" || name == "(p1 + p2) sgn(motor_speed)") << name;
  EXPECT_GT(most, 0.8);
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

// Tests what is offered: waves of a turn only on request, none for the arm; limits of the voltage with their places.
TEST(Variables, WhatIsOffered) {
  const std::vector<LackingRun> runs = {Forward(3)};
  EXPECT_EQ(MotionVariables(runs, BalanceKind::kFlow1, {}, true).size(),
            MotionVariables(runs, BalanceKind::kFlow1, {}, false).size() + 48);
  EXPECT_EQ(MotionVariables(runs, BalanceKind::kArm, {}, true).size(),
            MotionVariables(runs, BalanceKind::kArm, {}, false).size());
  const std::vector<Variable> commands = CommandVariables(runs);
  ASSERT_EQ(commands.size(), 11u);
  EXPECT_EQ(commands[1].where, "|voltage| > 5 V");
  EXPECT_TRUE(commands[1].linear_only);
  EXPECT_NEAR(commands[1].values[0].front(), 5, 1e-9);  // of 10 V
  EXPECT_NEAR(commands[1].values[0].back(), 0, 1e-9);   // of 2 V
  // The rate of p2 - p1 is 200 psi/s.
  const std::vector<Variable> late = LateVariables(runs, BalanceKind::kTorque, {});
  ASSERT_EQ(late.size(), 1u);
  EXPECT_NEAR(late[0].values[0][100], 200, 1e-6);
  EXPECT_TRUE(LateVariables(runs, BalanceKind::kArm, {}).empty());
}

// Tests that what is lacking is seen over what it depends on, and that nothing is seen in noise or where there is no balance.
TEST(Seen, WhatIsLacking) {
  const Seen seen = LookAt({Forward(3), Forward(3)}, BalanceKind::kTorque, {});
  EXPECT_GT(seen.energy, 1000);
  ASSERT_FALSE(seen.ranked.empty());
  EXPECT_EQ(seen.ranked.front().variable.name, "motor_speed");
  EXPECT_GT(seen.ranked.front().explained, 0.8);
  EXPECT_EQ(LookAt({Forward(0), Forward(0)}, BalanceKind::kTorque, {}).energy, 0);
  EXPECT_TRUE(LookAt({Forward(3)}, BalanceKind::kFlow1, {}).when.blocks.empty());
}

}  // namespace
}  // namespace hydro::diagnose
