#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/maths/linear_fit.h"
#include "experiments/figures/catalogue.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/pump_friction.h"
#include "plant/simulated_rig.h"
#include "settings/model_file.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

const model::Parameters& Table1() {
  static const model::Parameters parameters = ShippedModel("table1").parameters;
  return parameters;
}

// One run of the experiment, shared by all tests of it.
class FrictionTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { result_ = new ExperimentResult(RunFriction({})); }
  static void TearDownTestSuite() { delete result_; }
  static json Numbers() { return ParseJson(result_->numbers); }
  static ExperimentResult* result_;
};
ExperimentResult* FrictionTest::result_ = nullptr;

// Tests that T_s and b of the simulated rig come back within 1 % from noisy, quantised signals, by the speed
// and by the encoder, and within what the intervals and the hidden acceleration allow.
TEST_F(FrictionTest, RecoversTheRig) {
  const json numbers = Numbers();
  for (const json& found : {numbers, numbers.at("from_encoder")}) {
    EXPECT_NEAR(found.at("T_s"), 4.0, 0.04);
    EXPECT_NEAR(found.at("b"), 0.01455, 0.0001455);
  }
  const double hidden = numbers.at("acceleration_may_take_in_lbf");
  EXPECT_LT(hidden, 0.005 * 5);  // the criterion: 0.5 % of the least torque
  const double T_s_half =
      (numbers.at("ci95").at("T_s")[1].get<double>() - numbers.at("ci95").at("T_s")[0].get<double>()) / 2;
  EXPECT_NEAR(numbers.at("T_s"), 4.0, 2 * T_s_half + hidden);
  EXPECT_LT(T_s_half, 1e-3);
  EXPECT_GT(T_s_half, 1e-6);
  EXPECT_EQ(numbers.at("points").size(), 10u);
  for (const json& point : numbers.at("points")) {
    const double torque = point.at("torque_in_lbf");
    const double speed = (torque - std::copysign(4.0, torque)) / 0.01455;  // eq. (4) with dp = theta'' = 0
    EXPECT_NEAR(point.at("motor_speed_rad_s"), speed, 0.03);  // 0.3 rad/s over some 5000 samples: 7 errors
  }
}

// Tests that the ramp finds break-away at T_s plus what the ramp adds before movement shows: with the bypass
// open, J theta'' = T_p - T_s gives (6 J theta T_p'^2)^(1/3).
TEST_F(FrictionTest, BreakAwayOnTheRamp) {
  const json ramp = Numbers().at("break_away");
  const double moved = 4.5 * 2 * M_PI / 16384;
  EXPECT_NEAR(ramp.at("counts_as_moved_rad"), moved, 1e-12);
  EXPECT_NEAR(ramp.at("ramp_in_lbf_s"), 0.08, 1e-12);
  const double excess = std::cbrt(6 * 0.03 * moved * 0.08 * 0.08);
  EXPECT_NEAR(ramp.at("expected_excess_in_lbf"), excess, 1e-12);
  // At rest the encoder stands anywhere within a step, which is 1/9 of the way: 4 % of the cube root.
  for (const char* direction : {"forward_in_lbf", "backward_in_lbf"}) {
    EXPECT_NEAR(ramp.at(direction), 4.0 + excess, 0.05 * excess) << direction;
    EXPECT_NEAR(ramp.at(direction), 4.0, 0.04) << direction;  // within 1 %
  }
}

// Tests that the result has what the report shows: comparisons, a table of the points, two pictures.
TEST_F(FrictionTest, Report) {
  ASSERT_GE(result_->comparisons.size(), 4u);
  EXPECT_EQ(result_->comparisons[0].paper, "4.0");
  EXPECT_EQ(result_->comparisons[0].expected, 4.0);
  EXPECT_EQ(result_->comparisons[0].here, Numbers().at("T_s"));
  EXPECT_EQ(result_->comparisons[1].paper, "0.01455");
  EXPECT_EQ(result_->table.rows(), 10u);
  ASSERT_EQ(result_->pictures.size(), 2u);
  EXPECT_EQ(result_->pictures[0].suffix, "");
  EXPECT_THAT(result_->explanation, HasSubstr("95 %"));
}

// A noiseless bypass run, from the model alone: voltages held one after the other.
struct CleanHold {
  double voltage;
  double duration;
};
runs::MeasuredRun SimulateHolds(const model::ModelDescription& model, const std::vector<CleanHold>& holds,
                                double interval) {
  model::Actuator actuator(model, {.shaft = model::Shaft::kClamped, .bypass = true});
  runs::MeasuredRun run;
  run.name = run.file = "holds.csv";
  run.shaft = model::Shaft::kClamped;
  run.bypass = true;
  double begin = 0;
  for (const CleanHold& hold : holds) {
    const int samples = static_cast<int>(std::round(hold.duration / interval));
    for (int i = 0; i < samples; ++i) {
      const double time = begin + i * interval;
      actuator.Advance(run.voltage.measured() ? run.voltage.values.back() : 0, time);
      run.time.push_back(time);
      run.voltage.values.push_back(hold.voltage);
      run.motor_speed.values.push_back(actuator.Measure().motor_speed);
      run.motor_angle.values.push_back(actuator.Measure().motor_angle);
    }
    begin += hold.duration;
  }
  return run;
}

std::vector<CleanHold> BothWays(double duration) {
  std::vector<CleanHold> holds;
  for (const double voltage : {1.25, 1.75, 2.25, 3.0, -1.25, -1.75, -2.25, -3.0})
    holds.push_back({voltage, duration});
  return holds;
}

runs::MeasuredRun WithNoise(runs::MeasuredRun run, double deviation, int64_t seed) {
  for (size_t i = 0; i < run.samples(); ++i) {
    run.motor_speed.values[i] +=
        deviation * plant::StandardNormal(static_cast<uint64_t>(seed), static_cast<int64_t>(i), 3);
  }
  return run;
}

std::string ErrorOf(const runs::MeasuredRun& run) {
  try {
    FitPumpFriction(run, SpeedSourceOf(run), Table1());
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError was thrown";
  return {};
}

// Tests that the 95 % intervals are honest: over 120 draws of the noise they hold the truth in 90 to 99 %.
TEST(PumpFrictionTest, IntervalsAreHonest) {
  const runs::MeasuredRun clean = SimulateHolds(ShippedModel("table1"), BothWays(40), 0.02);
  const int draws = 120;
  int T_s_held = 0, b_held = 0, difference_held = 0;
  for (int seed = 1; seed <= draws; ++seed) {
    const PumpFriction friction = FitPumpFriction(WithNoise(clean, 0.3, seed), SpeedSource::kSpeed, Table1());
    ASSERT_EQ(friction.points.size(), 8u);
    T_s_held += friction.T_s.low <= 4.0 && 4.0 <= friction.T_s.high;
    b_held += friction.b.low <= 0.01455 && 0.01455 <= friction.b.high;
    difference_held += friction.difference.low <= 0 && 0 <= friction.difference.high;
  }
  for (const int held : {T_s_held, b_held, difference_held}) {
    EXPECT_GE(held, 0.90 * draws);
    EXPECT_LE(held, 0.99 * draws);
  }
}

// Tests that the intervals also hold the truth where the error is what is left of the transients, not noise:
// it is alike at all points, so their scatter alone would promise too much.
TEST(PumpFrictionTest, IntervalsKnowOfTransients) {
  int beyond_scatter = 0;
  for (const SpeedSource source : {SpeedSource::kSpeed, SpeedSource::kAngle}) {
    for (const double duration : {14.0, 16.0, 20.0, 30.0}) {  // 7 to 15 time constants J/b
      const PumpFriction friction =
          FitPumpFriction(SimulateHolds(ShippedModel("table1"), BothWays(duration), 0.02), source, Table1());
      EXPECT_LE(friction.T_s.low, 4.0) << duration;
      EXPECT_GE(friction.T_s.high, 4.0) << duration;
      EXPECT_LE(friction.b.low, 0.01455) << duration;
      EXPECT_GE(friction.b.high, 0.01455) << duration;
      EXPECT_LT(friction.T_s.half_width(), 0.04) << duration;  // 1 %: still worth something
      beyond_scatter += std::abs(friction.T_s.value - 4.0) > 2.4 * friction.scatter / std::sqrt(8.0);
    }
  }
  EXPECT_GT(beyond_scatter, 0);
}

// Tests that without noise the fit is exact but for what is left of the transients (15 time constants).
TEST(PumpFrictionTest, ExactWithoutNoise) {
  for (const SpeedSource source : {SpeedSource::kSpeed, SpeedSource::kAngle}) {
    const PumpFriction friction =
        FitPumpFriction(SimulateHolds(ShippedModel("table1"), BothWays(30), 0.02), source, Table1());
    EXPECT_NEAR(friction.T_s.value, 4.0, 1e-4);
    EXPECT_NEAR(friction.b.value, 0.01455, 1e-6);
  }
}

// Tests that friction that differs between directions is found to.
TEST(PumpFrictionTest, DirectionsDiffer) {
  const model::ModelDescription model = settings::ParseModel(
      ShippedModelText("table1") + "[effects.\"pump.friction_asymmetry\"]\ncoulomb = 0.3\nviscous = 0.0\n",
      "asymmetric.toml");
  const PumpFriction friction = FitPumpFriction(WithNoise(SimulateHolds(model, BothWays(30), 0.02), 0.3, 1),
                                                SpeedSource::kSpeed, Table1());
  EXPECT_NEAR(friction.T_s_forward.value, 4.3, 0.01);
  EXPECT_NEAR(friction.T_s_backward.value, 3.7, 0.01);
  EXPECT_NEAR(friction.difference.value, 0.6, 0.01);
  EXPECT_GT(friction.difference.low, 0.5);
  EXPECT_NEAR(friction.T_s.value, 4.0, 0.01);
}

// Tests that only steady stretches are used: holds cut short, and a voltage that does not turn the motor, are
// left out.
TEST(PumpFrictionTest, OnlySteadyHoldsCount) {
  std::vector<CleanHold> holds = BothWays(30);
  holds.push_back({2.0, 1.0});
  holds.push_back({0.9, 10});
  const PumpFriction friction = FitPumpFriction(
      WithNoise(SimulateHolds(ShippedModel("table1"), holds, 0.02), 0.3, 1), SpeedSource::kSpeed, Table1());
  EXPECT_EQ(friction.points.size(), 8u);
  EXPECT_NEAR(friction.T_s.value, 4.0, 0.01);
}

// Tests that a noisy command (a measured current) and missing speeds do no harm.
TEST(PumpFrictionTest, NoisyCommandAndGaps) {
  runs::MeasuredRun run = WithNoise(SimulateHolds(ShippedModel("table1"), BothWays(30), 0.02), 0.3, 1);
  for (size_t i = 0; i < run.samples(); ++i) {
    run.voltage.values[i] += 0.01 * plant::StandardNormal(5, static_cast<int64_t>(i), 0);
    if (i % 7 == 0) run.motor_speed.values[i] = std::nan("");
  }
  const PumpFriction friction = FitPumpFriction(run, SpeedSource::kSpeed, Table1());
  EXPECT_NEAR(friction.T_s.value, 4.0, 0.04);
  EXPECT_NEAR(friction.b.value, 0.01455, 0.0001455);
}

// Tests each way in which a run can fail to support the fit: the message says what was found and what is
// allowed.
TEST(PumpFrictionTest, Errors) {
  const model::ModelDescription model = ShippedModel("table1");
  runs::MeasuredRun run = SimulateHolds(model, BothWays(30), 0.02);
  run.bypass = false;
  EXPECT_THAT(ErrorOf(run), AllOf(HasSubstr("holds.csv: found the bypass closed"), HasSubstr("allowed")));

  run = SimulateHolds(model, BothWays(30), 0.02);
  run.motor_speed = run.motor_angle = {};
  EXPECT_THAT(ErrorOf(run), HasSubstr("found neither motor_speed nor motor_angle"));

  // 2 s of a time constant of 2.06 s: after the first half, a third of the approach is left.
  run = WithNoise(SimulateHolds(model, {{2, 1}, {3, 2}, {-2, 1}}, 0.01), 0.3, 1);
  EXPECT_THAT(ErrorOf(run), AllOf(HasSubstr("found no steady state: in the longest hold, of 3 V"),
                                  HasSubstr("rad/s^2 from 1.995 s to 2.99 s"), HasSubstr("of 12 in-lbf")));

  run = SimulateHolds(model, {{2, 1}}, 0.01);
  for (size_t i = 0; i < run.samples(); ++i) run.voltage.values[i] = 1 + 0.02 * static_cast<double>(i);
  EXPECT_THAT(ErrorOf(run), HasSubstr("found no steady state: the motor never turns under a voltage"));

  EXPECT_THAT(ErrorOf(SimulateHolds(model, {{1.5, 30}, {2, 30}, {2.5, 30}, {3, 30}}, 0.02)),
              HasSubstr("found steady speeds forward only (4)"));
  EXPECT_THAT(ErrorOf(SimulateHolds(model, {{-1.5, 30}, {-2, 30}}, 0.02)),
              HasSubstr("found steady speeds backward only (2)"));
  EXPECT_THAT(ErrorOf(SimulateHolds(model, {{1.5, 30}, {2, 30}, {-1.5, 30}, {-2, 30}}, 0.02)),
              HasSubstr("found 2 different speeds in 4 steady holds"));
}

// Tests that times in another unit than is said, which would make days of holds, are refused at once with the
// unit that is meant.
TEST(FrictionRunFile, TimesInAnotherUnit) {
  const runs::MeasuredRun run = WithNoise(SimulateHolds(ShippedModel("table1"), BothWays(30), 0.02), 0.3, 1);
  for (const auto& [unit, factor] : {std::pair("ns", 1e9), {"us", 1e6}, {"ms", 1e3}}) {
    const std::string stem =
        testing::TempDir() + "/" + unit + "_friction_times";  // no file that was read is replaced
    std::ofstream(stem + ".toml")
        << "shaft = \"free\"\nbypass = true\n[columns]\ntime = \"t\"\nvoltage = \"v\"\nmotor_speed = \"w\"\n";
    ExperimentOptions options;
    options.measured_run = stem + ".csv";
    tables::Table table;
    table.columns = {{"t", run.time}, {"v", run.voltage.values}, {"w", run.motor_speed.values}};
    for (double& time : table.columns[0].values) time *= factor;
    tables::WriteTable(table, stem + ".csv");
    for (const auto& analyse : {RunFriction, RunLeakage}) {
      try {
        analyse(options);
        ADD_FAILURE() << "times in " << unit << " are taken";
      } catch (const InputError& error) {
        EXPECT_THAT(
            error.what(),
            AllOf(HasSubstr("friction_times.csv: time: found rows "), HasSubstr("allowed at most 0.25 s"),
                  HasSubstr(std::string("(is the column in ") + unit + "? unit = \"" + unit + "\")")));
      }
    }
    std::filesystem::remove(stem + ".csv");
    std::filesystem::remove(stem + ".toml");
  }
}

// Tests that a file with its sidecar is analysed like a run of the simulated rig, using the angle where there
// is no speed.
TEST(FrictionRunFile, TableWithSidecar) {
  const std::string stem = testing::TempDir() + "/friction_run_file";
  tables::Table table;
  const runs::MeasuredRun run = WithNoise(SimulateHolds(ShippedModel("table1"), BothWays(30), 0.02), 0.3, 1);
  table.columns = {{"t", run.time},
                   {"v", run.voltage.values},
                   {"w", run.motor_speed.values},
                   {"th", run.motor_angle.values}};
  tables::WriteTable(table, stem + ".csv");
  for (const char* signal : {"motor_speed = \"w\"\n", "motor_angle = \"th\"\n"}) {
    std::ofstream(stem + ".toml")
        << "shaft = \"free\"\nbypass = true\n[columns]\ntime = \"t\"\nvoltage = \"v\"\n"
        << signal;
    ExperimentOptions options;
    options.measured_run = stem + ".csv";
    const ExperimentResult result = RunFriction(options);
    const json numbers = ParseJson(result.numbers);
    EXPECT_NEAR(numbers.at("T_s"), 4.0, 0.04);
    EXPECT_NEAR(numbers.at("b"), 0.01455, 0.0001455);
    EXPECT_FALSE(numbers.contains("break_away"));
    EXPECT_THAT(result.conditions, HasSubstr("friction_run_file"));
  }
  std::filesystem::remove(stem + ".csv");
  std::filesystem::remove(stem + ".toml");
}

// Tests that a real run that has neither an open bypass nor steady speeds is refused with the reason.
TEST(FrictionRunFile, RealRunWithoutBypass) {
  const std::filesystem::path data = std::filesystem::path(HYDRO_MEASURED_DATA) / "buoy_pto";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no measured data at " << data;
  const std::string stem = testing::TempDir() + "/friction_buoy";
  std::filesystem::copy_file(data / "friction_moves_bias_current.csv", stem + ".csv",
                             std::filesystem::copy_options::overwrite_existing);
  const std::string columns =
      "[columns]\ntime = \"time(s)\"\nvoltage = \"TargetWindingCurrent(A)\"\n"
      "motor_speed = { column = \"RPM\", scale = 0.10471975512 }\narm_angle = \"Pos(in)\"\n";
  const auto error_with = [&](const std::string& head) -> std::string {
    std::ofstream(stem + ".toml") << head << columns;
    ExperimentOptions options;
    options.measured_run = stem + ".csv";
    try {
      RunFriction(options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(error_with("shaft = \"driven\"\n"),
              AllOf(HasSubstr("friction_buoy.csv: found the bypass closed"), HasSubstr("allowed")));
  // If it claimed an open bypass: the test machine moves the motor to and fro under one current.
  EXPECT_THAT(error_with("shaft = \"driven\"\nbypass = true\n"), HasSubstr("friction_buoy.csv: found"));
  std::filesystem::remove(stem + ".csv");
  std::filesystem::remove(stem + ".toml");
}

// Tests the fit of a line against a textbook's: y = 1, 3, 2, 5 at x = 0, 1, 2, 3.
TEST(LinearFitTest, Line) {
  const maths::LinearFit fit = maths::FitLinear({{1, 1, 1, 1}, {0, 1, 2, 3}}, {1, 3, 2, 5});
  EXPECT_NEAR(fit.coefficients[0], 1.1, 1e-12);
  EXPECT_NEAR(fit.coefficients[1], 1.1, 1e-12);
  EXPECT_EQ(fit.degrees_of_freedom, 2);
  EXPECT_NEAR(fit.residual_deviation, std::sqrt(2.7 / 2), 1e-12);
  EXPECT_NEAR(fit.StandardError({0, 1}), std::sqrt(1.35 / 5), 1e-12);
  EXPECT_NEAR(fit.HalfWidth95({0, 1}), 4.302652730 * std::sqrt(1.35 / 5), 1e-8);
  EXPECT_NEAR(maths::StudentT95(7), 2.364624252, 1e-8);  // tables
  EXPECT_TRUE(std::isinf(maths::StudentT95(0)));
  EXPECT_THROW(maths::FitLinear({{1, 1, 1}, {2, 2, 2}}, {1, 2, 3}), std::invalid_argument);
}

}  // namespace
}  // namespace hydro::experiments
