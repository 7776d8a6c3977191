// Tests of quantities that two sensors measured.
#include "diagnose/recording/second_sensors.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <regex>
#include <string>

namespace hydro::diagnose {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Measured = runs::MeasuredRun;

// How a second sensor reads.
struct SensorReads {
  double factor = 1, offset = 0, late = 0;
};
struct TwoSensors {
  SensorReads speed, arm, dp;
  double step = 2e-3;
  uint64_t seed = 1;
};

// 20 s of a free arm whose motor and pressures swing, with noise and an encoder's steps.
Measured SwingOf(const TwoSensors& how) {
  Measured run;
  run.name = "swing";
  run.shaft = model::Shaft::kFree;
  std::mt19937_64 random(how.seed);
  std::normal_distribution<double> normal;
  const auto speed = [](double t) { return 90 * std::sin(2 * t) + 30 * std::cos(7 * t); };
  const auto angle = [](double t) { return -45 * std::cos(2 * t) + 30.0 / 7 * std::sin(7 * t); };
  const auto pressed = [](double t) { return 200 * std::sin(3 * t) + 50 * std::sin(11 * t); };
  const auto arm = [](double t) { return 0.3 * std::sin(1.3 * t); };
  const auto arm_speed = [](double t) { return 0.39 * std::cos(1.3 * t); };
  const auto read = [&](const auto& of, double t, const SensorReads& by, double noise) {
    return by.factor * of(t - by.late) + by.offset + noise * normal(random);
  };
  for (int k = 0; how.step * k < 20; ++k) {
    const double t = how.step * k;
    run.time.push_back(t);
    run.voltage.values.push_back(std::sin(t));
    run.motor_speed.values.push_back(read(speed, t, how.speed, 1));
    run.motor_angle.values.push_back(1.5e-3 * std::round(angle(t) / 1.5e-3));
    run.arm_speed.values.push_back(read(arm_speed, t, how.arm, 0.01));
    run.arm_angle.values.push_back(3e-4 * std::round(arm(t) / 3e-4));
    run.p1.values.push_back(300 - pressed(t) / 2 + 1.5 * normal(random));
    run.p2.values.push_back(300 + pressed(t) / 2 + 1.5 * normal(random));
    run.dp.values.push_back(read(pressed, t, how.dp, 1.5));
  }
  run.motor_speed.source.column = "rpm";
  run.motor_speed.source.scale = 0.1;
  run.arm_speed.source.column = "v";
  run.dp.source.column = "diff";
  return run;
}

// The value and half width behind `before` in "... 1.1403 +/- 0.0012 ...".
std::pair<double, double> IntervalAfter(const std::string& text, const std::string& before) {
  std::smatch found;
  const std::regex number(before + R"(([-0-9.e]+) \+/- ([-0-9.e]+))");
  if (!std::regex_search(text, found, number)) return {0, 0};
  return {std::stod(found[1]), std::stod(found[2])};
}

// Tests that sensors that agree to their noise say nothing, at several rates and with several seeds, and that
// a speed that is late by less than filters are is moved.
TEST(SecondSensors, ThatAgreeSayNothing) {
  for (const double step : {5e-4, 2e-3, 1e-2}) {
    for (const uint64_t seed : {1, 2, 3, 4}) {
      TwoSensors how{{1.01, 0.3, 1e-3}, {0.99, 0, 1e-3}, {1.005, 1, 1e-3}, step, seed};
      const ComparedSensors compared = CompareSensors({SwingOf(how)});
      EXPECT_THAT(compared.remarks, IsEmpty()) << step << ", seed " << seed;
      for (const ComparedSensors::Unbelieved& moved : compared.unbelieved) {
        ASSERT_TRUE(moved.reads.has_value());
        EXPECT_EQ(moved.reads->factor, 1);
        EXPECT_EQ(moved.reads->offset, 0);
        EXPECT_NEAR(moved.reads->late, 1e-3, 5e-4) << step << ", seed " << seed;
      }
      const auto speed = [](const ComparedSensors::Unbelieved& one) {
        return one.signal == &Measured::motor_speed;
      };
      EXPECT_EQ(std::ranges::count_if(compared.unbelieved, speed), 1) << step << ", seed " << seed;
    }
  }
}

// Tests that a speed column that disagrees by a factor is not believed, that the factor's interval holds it,
// and that the line for the sidecar undoes it.
TEST(SecondSensors, SpeedOfAnotherFactor) {
  for (const double factor : {1.14, 0.9, 3.0}) {
    const TwoSensors how{{factor, 0, 0}, {}, {}, 2e-3, 5};
    std::vector<Measured> runs = {SwingOf(how), SwingOf(how)};
    const ComparedSensors compared = CompareSensors(runs);
    ASSERT_EQ(compared.remarks.size(), 1u);
    const std::string& said = compared.remarks[0];
    EXPECT_THAT(said, AllOf(HasSubstr("every run: motor_speed is "),
                            HasSubstr("as fast as motor_angle turns: the angle is believed")));
    const auto [value, half] = IntervalAfter(said, "motor_speed is ");
    EXPECT_NEAR(value, factor, half) << said;
    EXPECT_LT(half, 0.01 * factor) << said;
    std::smatch line;
    ASSERT_TRUE(std::regex_search(said, line, std::regex(R"(column = "rpm", scale = ([0-9.]+))"))) << said;
    EXPECT_NEAR(std::stod(line[1]), 0.1 / factor, 1e-3 * 0.1 / factor);
    const double before = runs[0].motor_speed.values[100];
    CorrectOrLeaveOut(compared.unbelieved, {&runs[0], &runs[1]});
    for (const Measured& run : runs)
      EXPECT_NEAR(run.motor_speed.values[100], before / factor, 0.02 * std::abs(before));
    EXPECT_THAT(CompareSensors(runs).remarks, IsEmpty());
  }
}

// Tests that a sensor whose factor is not known as well as sensors agree anyway is left out, and one with an
// offset is corrected by it, with its noise.
TEST(SecondSensors, CorrectedOnlyWhereItsFactorIsKnown) {
  Measured run = SwingOf({{1.2, 4, 0}, {}, {}, 2e-3, 5});
  run.motor_speed.noise = 1.2;
  const std::vector<double> recorded = run.motor_speed.values;
  const auto motor_speed = &Measured::motor_speed;
  CorrectOrLeaveOut({{0, motor_speed, diagnose::SecondSensor{.factor = 1.2, .offset = 4}}}, {&run});
  for (size_t k = 0; k < recorded.size(); k += 1000)
    EXPECT_DOUBLE_EQ(run.motor_speed.values[k], (recorded[k] - 4) / 1.2);
  EXPECT_DOUBLE_EQ(*run.motor_speed.noise, 1);
  CorrectOrLeaveOut({{0, motor_speed, std::nullopt}}, {&run});
  EXPECT_FALSE(run.motor_speed.measured());

  // A speed as noisy as it is large: nobody knows its factor to 2 %.
  Measured noisy = SwingOf({{1.5, 0, 0}, {}, {}, 2e-3, 5});
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 300);
  for (double& value : noisy.motor_speed.values) value += normal(random);
  const ComparedSensors compared = CompareSensors({noisy});
  ASSERT_EQ(compared.unbelieved.size(), 1u);
  EXPECT_FALSE(compared.unbelieved[0].reads.has_value());
  EXPECT_THAT(compared.remarks[0], HasSubstr("and the speed is left out"));
}

// Tests that of a late speed the time is said, with its interval, and that the speed is moved by it.
TEST(SecondSensors, LateSpeed) {
  Measured run = SwingOf({{1, 0, 0.012}, {}, {}, 2e-3, 3});
  const ComparedSensors compared = CompareSensors({run});
  ASSERT_EQ(compared.remarks.size(), 1u);
  EXPECT_THAT(compared.remarks[0], HasSubstr("s later than motor_angle: the angle is believed"));
  const auto [value, half] = IntervalAfter(compared.remarks[0], "motor_speed is ");
  EXPECT_NEAR(value, 0.012, half + 5e-4);
  EXPECT_LT(half, 1e-3);
  const std::vector<double> recorded = run.motor_speed.values;
  CorrectOrLeaveOut(compared.unbelieved, {&run});
  EXPECT_NEAR(run.motor_speed.values[1000], recorded[1006], 4) << "noise of 1";
  EXPECT_TRUE(std::isnan(run.motor_speed.values.back())) << "nothing was read so late";
  EXPECT_THAT(CompareSensors({run}).remarks, IsEmpty());
}

// Tests that the arm's angle is believed before its speed.
TEST(SecondSensors, ArmSpeedOfAnotherFactor) {
  const ComparedSensors compared = CompareSensors({SwingOf({{}, {0.8, 0, 0}, {}, 2e-3, 2})});
  EXPECT_THAT(compared.remarks,
              ElementsAre(AllOf(HasSubstr("run swing: arm_speed is "), HasSubstr("arm_angle is believed"),
                                HasSubstr("arm_speed = { column = \"v\", scale = 1.2"))));
  const auto [value, half] = IntervalAfter(compared.remarks[0], "arm_speed is ");
  EXPECT_NEAR(value, 0.8, half);
  EXPECT_LT(half, 0.01);
  ASSERT_EQ(compared.unbelieved.size(), 1u);
  EXPECT_EQ(compared.unbelieved[0].signal, &Measured::arm_speed);
}

// Tests that a differential transducer is held against p1 and p2: its factor and its zero.
TEST(SecondSensors, DifferentialTransducer) {
  const ComparedSensors compared = CompareSensors({SwingOf({{}, {}, {0.93, 12, 0}, 2e-3, 2})});
  ASSERT_EQ(compared.remarks.size(), 1u);
  const std::string& said = compared.remarks[0];
  EXPECT_THAT(said, AllOf(HasSubstr("times p2 - p1 and 1"), HasSubstr("psi more: p1 and p2 are believed")));
  const auto [factor, half] = IntervalAfter(said, "dp is ");
  EXPECT_NEAR(factor, 0.93, half);
  const auto [offset, offset_half] = IntervalAfter(said, "p2 - p1 and ");
  EXPECT_NEAR(offset, 12, offset_half);
  EXPECT_THAT(compared.unbelieved, IsEmpty());
}

// Tests that a differential transducer of the wrong sign is said, with the line that mends it, and so is a
// column that is no dp: noise, another signal or one that does not change.
TEST(SecondSensors, DpThatIsInvertedOrAnother) {
  EXPECT_THAT(CompareSensors({SwingOf({{}, {}, {-1, 0, 0}, 2e-3, 2})}).remarks,
              ElementsAre(AllOf(HasSubstr("dp is -0.99"), HasSubstr("times p2 - p1"),
                                HasSubstr("if they are not exchanged"),
                                HasSubstr("dp = { column = \"diff\", scale = -1.0"))));
  Measured brief = SwingOf({{}, {}, {-1, 0, 0}, 2e-3, 2});
  brief.Keep(0, 750);
  EXPECT_THAT(CompareSensors({brief}).remarks,
              ElementsAre(::testing::ContainsRegex(
                  "dp does not follow p2 - p1 .correlation -(1|0.99).*: p1 and p2 are "
                  "believed; is the column \"diff\" of the other sign")));
  brief = SwingOf({});
  brief.Keep(0, 750);
  EXPECT_THAT(CompareSensors({brief}).remarks, IsEmpty());
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(500, 50);
  for (const int kind : {0, 1, 2, 3}) {
    Measured run = SwingOf({});
    for (size_t k = 0; k < run.samples(); ++k)
      run.dp.values[k] = kind == 0   ? normal(random)
                         : kind == 1 ? run.arm_speed.values[k] + 3
                         : kind == 2 ? 400
                                     : run.time[k];
    EXPECT_THAT(CompareSensors({run}).remarks,
                ElementsAre(AllOf(HasSubstr("run swing: dp does not follow p2 - p1 (correlation "),
                                  HasSubstr("is the column \"diff\" another quantity?"))))
        << kind;
  }
}

// Tests that nothing is said of a dp beside pressures that hardly move, or of a noisy or late one.
TEST(SecondSensors, DpThatMayBeRight) {
  Measured rest = SwingOf({});
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 1.5);
  for (size_t k = 0; k < rest.samples(); ++k) {
    rest.p1.values[k] = 300 + normal(random);
    rest.p2.values[k] = 320 + normal(random);
    rest.dp.values[k] = 20 + normal(random);
  }
  EXPECT_THAT(CompareSensors({rest}).remarks, IsEmpty());
  Measured noisy = SwingOf({});
  for (double& value : noisy.dp.values) value += 100 * normal(random);
  for (const std::string& said : CompareSensors({noisy}).remarks)
    EXPECT_THAT(said, ::testing::Not(HasSubstr("does not follow")));
}

// Tests that a speed of the wrong sign, one that has nothing to do with its angle, and a motor at rest are
// left to other checks.
TEST(SecondSensors, LeavesTheRest) {
  EXPECT_THAT(CompareSensors({SwingOf({{-1, 0, 0}, {}, {}, 2e-3, 2})}).remarks, IsEmpty());
  Measured noise = SwingOf({});
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (double& value : noise.motor_speed.values) value = 50 * normal(random);
  EXPECT_THAT(CompareSensors({noise}).remarks, IsEmpty());
  Measured rest = SwingOf({});
  for (double& value : rest.motor_angle.values) value = 3;
  for (double& value : rest.motor_speed.values) value = 0;
  EXPECT_THAT(CompareSensors({rest}).remarks, IsEmpty());
}

}  // namespace
}  // namespace hydro::diagnose
