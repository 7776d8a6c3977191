#include "diagnose/recording/measured_ratios.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "diagnose/recording/block_means.h"

namespace hydro::diagnose {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A cylinder whose c/D is 100.
model::ModelDescription Cylinder() {
  model::ModelDescription model;
  model.units = {"m", "N", true};
  model.parameters.c = 1e-3;
  model.parameters.D = 1e-5;
  model.parameters.k_2 = 1e-3;
  return model;
}

// 20 s to and fro. The motor turns `out` and `back` times as fast as the arm moves, and for leakage.
runs::MeasuredRun Moved(double out, double back) {
  runs::MeasuredRun run;
  run.shaft = model::Shaft::kFree;
  run.units = {"m", "N", true};
  double angle = 0;
  for (int k = 0; k <= 4000; ++k) {
    const double time = 0.005 * k, speed = 0.1 * std::cos(time), dp = 1e6 * std::sin(3 * time);
    run.time.push_back(time);
    run.arm_angle.values.push_back(0.1 * std::sin(time));
    run.p1.values.push_back(1e6);
    run.p2.values.push_back(1e6 + dp);
    run.motor_angle.values.push_back(angle);
    angle += 0.005 * ((speed > 0 ? out : back) * speed + 1e-6 * dp);
    run.voltage.values.push_back(1);
  }
  return run;
}

// Tests that blocks are as long as is said, and that none reaches over missing rows.
TEST(BlockMeans, Blocks) {
  runs::MeasuredRun run = Moved(100, 100);
  const std::vector<RunBlock> blocks = RunBlocksOf(run);
  ASSERT_EQ(blocks.size(), 200u);
  EXPECT_NEAR(blocks[7].seconds(), 0.1, 1e-9);
  EXPECT_NEAR(blocks[7].Mean(run.p1), 1e6, 1);
  EXPECT_NEAR(blocks[7].Rate(run.arm_angle), 0.1 * std::cos(0.75), 1e-4);
  EXPECT_TRUE(std::isnan(blocks[7].Mean(run.motor_speed)));
  for (size_t i = 1000; i < run.samples(); ++i) run.time[i] += 1;
  EXPECT_EQ(RunBlocksOf(run).size(), 199u);
}

// Tests that a fit finds its coefficients, and that too few values, or what it leaves, say nothing.
TEST(BlockMeans, Fits) {
  std::vector<double> x, y, other;
  for (int i = 0; i < 30; ++i) {
    x.push_back(i);
    y.push_back(2 * i);
    other.push_back(i % 2 == 0 ? 1 : -1);
  }
  const std::optional<FittedBlocks> fit = FitBlocks({x, std::vector<double>(30, 0.0)}, y);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->value[0], 2, 1e-9);
  EXPECT_EQ(fit->value[1], 0);
  EXPECT_FALSE(FitBlocks({x}, other).has_value());
  x.resize(19), y.resize(19);
  EXPECT_FALSE(FitBlocks({x}, y).has_value());
}

// Tests that c/D is said where it is not the model's, with what it may come from, and nothing where it is.
TEST(MeasuredRatios, OfMotorAndArm) {
  EXPECT_THAT(RatioRemarks(Cylinder(), {Moved(101, 101)}), IsEmpty());
  EXPECT_THAT(RatioRemarks(Cylinder(), {Moved(110, 110)}),
              ElementsAre(AllOf(HasSubstr("c/D = 110."), HasSubstr("the model 100 (1.1 times as much"),
                                HasSubstr("a bore"))));
  const double turn = 2 * std::numbers::pi;
  // A displacement per revolution is 2 pi times as large as one per radian, so the motor turns 2 pi times as
  // far as the model says. A speed in revolutions a second is as much too small.
  model::ModelDescription per_revolution = Cylinder();
  per_revolution.parameters.D *= turn;
  EXPECT_THAT(RatioRemarks(per_revolution, {Moved(100, 100)}), ElementsAre(HasSubstr("per revolution?")));
  EXPECT_THAT(RatioRemarks(Cylinder(), {Moved(100 / turn, 100 / turn)}), ElementsAre(HasSubstr("in rev/s?")));
  EXPECT_THAT(RatioRemarks(Cylinder(), {Moved(-100, -100)}), ElementsAre(HasSubstr("the other way")));
  EXPECT_THAT(
      RatioRemarks(Cylinder(), {Moved(108, 92)}),
      ElementsAre(AllOf(HasSubstr("c/D = 108"), HasSubstr(" upwards and 92"), HasSubstr("unequal areas"))));
}

// Tests that a ratio which the recording shows only roughly is no statement on the bore. Friction makes the
// pressures follow the arm's speed here, so that a little of the motor's speed that goes with the rest of
// them, and a rough angle, shift the ratio by half.
TEST(MeasuredRatios, WhatIsRoughIsNotSaid) {
  std::mt19937 random(1);
  std::normal_distribution<double> rough(0, 0.03);
  for (const double share : {-5e-6, 5e-6}) {
    runs::MeasuredRun run = Moved(100, 100);
    double angle = 0;
    for (size_t k = 0; k < run.samples(); ++k) {
      const double speed = 0.1 * std::cos(run.time[k]), rest = 1e5 * std::sin(3 * run.time[k]);
      run.p2.values[k] = run.p1.values[k] + 1e7 * speed + rest;
      run.motor_angle.values[k] = angle + rough(random);
      angle += 0.005 * (100 * speed + share * rest);
    }
    EXPECT_THAT(RatioRemarks(Cylinder(), {run}), IsEmpty()) << share;
  }
}

// Tests that what holds still, or was not measured, says nothing.
TEST(MeasuredRatios, NeedMotion) {
  runs::MeasuredRun run = Moved(120, 120);
  run.shaft = model::Shaft::kClamped;
  EXPECT_THAT(RatioRemarks(Cylinder(), {run}), IsEmpty());
  run = Moved(120, 120);
  run.arm_angle = {};
  EXPECT_THAT(RatioRemarks(Cylinder(), {run}), IsEmpty());
  // Without pressures the speeds still do.
  run = Moved(120, 120);
  run.p1 = {};
  EXPECT_THAT(RatioRemarks(Cylinder(), {run}), ElementsAre(HasSubstr("(1.21 times")));
}

// Tests a load cell: its share, the friction, and a cell that is the wrong way round.
TEST(MeasuredRatios, OfALoadCell) {
  runs::MeasuredRun run = Moved(100, 100);
  for (size_t k = 0; k < run.samples(); ++k) {
    const double sign = std::cos(run.time[k]) > 0 ? 1 : -1;
    run.arm_force.values.push_back(-0.9e-3 * (run.p2.values[k] - run.p1.values[k]) + 50 * sign + 20);
  }
  EXPECT_THAT(RatioRemarks(Cylinder(), {run}),
              ElementsAre(AllOf(HasSubstr("arm_force is 0.9"), HasSubstr("friction of 50"),
                                HasSubstr("constant of 20"), HasSubstr("is off by as much"))));
  for (double& force : run.arm_force.values) force = -force;
  EXPECT_THAT(RatioRemarks(Cylinder(), {run}), ElementsAre(HasSubstr("scale = -1")));
}

// Tests that an exact load cell of a cylinder with unequal areas is held against the model's load pressure.
TEST(MeasuredRatios, OfALoadCellOnUnequalAreas) {
  model::ModelDescription model = Cylinder();
  model.effects = {{.id = "actuator.unequal_areas", .parameters = {{"difference", 0.3}}, .names = {}}};
  runs::MeasuredRun run = Moved(100, 100);
  for (size_t k = 0; k < run.samples(); ++k)
    run.arm_force.values.push_back(-1e-3 * (1.3 * run.p2.values[k] - 0.7 * run.p1.values[k]));
  EXPECT_THAT(
      RatioRemarks(model, {run}),
      ::testing::Contains(AllOf(HasSubstr("arm_force is 1"), HasSubstr("k_2 (c_2 p2 - c_1 p1)/c holds"),
                                ::testing::Not(HasSubstr("is off by as much")))));
}

// Tests a winding: the voltage at the terminals against current and speed.
TEST(MeasuredRatios, OfAWinding) {
  runs::MeasuredRun run = Moved(100, 100);
  run.current_commands = true;
  for (size_t k = 0; k < run.samples(); ++k) {
    run.voltage.values[k] = 5 * std::sin(2 * run.time[k]);
    const double speed = 10 * std::cos(run.time[k]) + 1e-6 * (run.p2.values[k] - run.p1.values[k]);
    run.motor_voltage.values.push_back(0.32 * run.voltage.values[k] + 0.086 * speed);
  }
  EXPECT_THAT(RatioRemarks(Cylinder(), {run}),
              ElementsAre(AllOf(HasSubstr("R = 0.3"), HasSubstr("k_e = 0.08"))));
}

}  // namespace
}  // namespace hydro::diagnose
