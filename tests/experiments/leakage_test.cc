#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "experiments/figures/catalogue.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/leakage_fit.h"
#include "plant/simulated_rig.h"
#include "settings/model_file.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// One run of the experiment, shared by all tests of it.
class LeakageTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { result_ = new ExperimentResult(RunLeakage({})); }
  static void TearDownTestSuite() { delete result_; }
  static json Numbers() { return ParseJson(result_->numbers); }
  static ExperimentResult* result_;
};
ExperimentResult* LeakageTest::result_ = nullptr;

// Tests that both coefficients of the simulated rig come back within 5 % from noisy, quantised pressures, are
// told apart, and leave nothing but the sensors' noise.
TEST_F(LeakageTest, RecoversTheRig) {
  const json numbers = Numbers();
  EXPECT_NEAR(numbers.at("c_E"), 6.5e-6, 0.05 * 6.5e-6);
  EXPECT_NEAR(numbers.at("c_I"), 1.0e-6, 0.05 * 1.0e-6);
  EXPECT_TRUE(numbers.at("converged"));
  EXPECT_THAT(numbers.at("not_identifiable"), IsEmpty());
  for (const auto& [name, truth] : {std::pair("c_E", 6.5e-6), std::pair("c_I", 1.0e-6)}) {
    const double low = numbers.at("ci95").at(name)[0], high = numbers.at("ci95").at(name)[1];
    EXPECT_LT(low, high);
    // Twice the 95 % interval: 4 standard errors.
    EXPECT_NEAR(numbers.at(name), truth, high - low) << name;
    EXPECT_LT(high - low, 0.05 * truth) << name;
  }
  // 36000 residuals: their mean square is 1 within 4 sqrt(2/36000), including the share of rounding.
  EXPECT_NEAR(numbers.at("rms_residual"), 1, 0.02);
  EXPECT_LT(std::abs(numbers.at("correlation").get<double>()), 0.99);
}

// Tests the closed forms of the stick: p_1 + p_2 - 2 p_3 decays with (beta/V) c_E and p_2 - p_1 with
// (beta/V)(c_E + 2 c_I), which suffices to find both coefficients.
TEST_F(LeakageTest, StickInClosedForm) {
  const json decay = Numbers().at("stick_decay");
  EXPECT_NEAR(decay.at("c_E"), 6.5e-6, 0.05 * 6.5e-6);
  EXPECT_NEAR(decay.at("c_I"), 1.0e-6, 0.10 * 1.0e-6);
  // The torque steps up at 0.1 s and the voltage acts a tick or two later; the stick is Figure 3's.
  EXPECT_NEAR(decay.at("from_s"), 0.1 + 0.252, 0.005);
  EXPECT_NEAR(decay.at("to_s"), 0.1 + 1.194, 0.02);
}

// Tests how the two are told apart: p_2 - p_1 alone, with both sides above p_3, tells c_E + 2 c_I (the rate
// of its decay) and little else, which leaves the errors of the two opposed; the two pressures tell both
// better.
TEST_F(LeakageTest, WhatTellsThemApart) {
  const json told = Numbers().at("told_by");
  EXPECT_NEAR(told.at("both_sides_above_p_3_dp_only").at("best_told_c_I_weight"), 2, 0.1);
  EXPECT_LT(told.at("both_sides_above_p_3_dp_only").at("correlation"), -0.9);
  EXPECT_GT(told.at("dp_only").at("c_I_error_percent").get<double>(),
            1.5 * told.at("all").at("c_I_error_percent").get<double>());
  EXPECT_GT(told.at("dp_only").at("c_E_error_percent").get<double>(),
            2 * told.at("all").at("c_E_error_percent").get<double>());
  EXPECT_LT(told.at("both_sides_above_p_3").at("c_I_error_percent"),
            told.at("one_side_at_p_3").at("c_I_error_percent"));
}

// Tests the influence of assumed values: pressures depend on beta c_E and beta c_I only while the pump
// sticks, so 1 % more beta gives about 1 % less of both.
TEST_F(LeakageTest, BulkModulusIsTakenAsKnown) {
  const json shift = Numbers().at("shift_percent_for_1_percent").at("beta");
  EXPECT_NEAR(shift.at("c_E"), -1, 0.3);
  EXPECT_NEAR(shift.at("c_I"), -1, 0.6);
}

// Tests that the typographical contradictions are shown with evidence.
TEST_F(LeakageTest, Finding) {
  ASSERT_EQ(result_->findings.size(), 1u);
  EXPECT_EQ(result_->findings[0].number, 10);
  EXPECT_THAT(result_->findings[0].paper, AllOf(HasSubstr("c_f"), HasSubstr("p_s")));
  EXPECT_NEAR(Numbers().at("low_side_while_creeping_psi"), 100, 0.7);  // 3 psi / sqrt(500), 5 errors
}

// Tests that the result has what the report shows.
TEST_F(LeakageTest, Report) {
  ASSERT_GE(result_->comparisons.size(), 2u);
  EXPECT_EQ(result_->comparisons[0].paper, "6.5e-6");
  EXPECT_EQ(result_->comparisons[0].here, Numbers().at("c_E"));
  EXPECT_EQ(result_->pictures.size(), 1u);
  EXPECT_EQ(result_->table.rows(), 4u * 4501u);
}

// A clamped run of the model alone, at 200 Hz: one torque, then none.
runs::MeasuredRun Clamped(const model::ModelDescription& model, double torque, int64_t seed, double noise = 3,
                          int samples = 900) {
  runs::MeasuredRun run;
  run.file = run.name = "clamped.csv";
  run.shaft = model::Shaft::kClamped;
  for (int i = 0; i < samples; ++i) {
    run.time.push_back(i * 0.005);
    run.voltage.values.push_back(i >= 20 && i < samples - 400 ? torque / model.parameters.k_1 : 0);
  }
  const SimulatedRun truth = SimulateClamped(model, run, model.parameters.p_3);
  run.p1.values = truth.p1;
  run.p2.values = truth.p2;
  for (int i = 0; i < samples; ++i) {
    const auto k = static_cast<size_t>(i);
    run.p1.values[k] += noise * plant::StandardNormal(static_cast<uint64_t>(seed), i, 0);
    run.p2.values[k] += noise * plant::StandardNormal(static_cast<uint64_t>(seed), i, 1);
  }
  run.p1.noise = run.p2.noise = noise;
  return run;
}

model::ModelDescription Leaking(double c_E, double c_I) {
  model::ModelDescription model = ShippedModel("table1");
  model.parameters.c_E = c_E;
  model.parameters.c_I = c_I;
  return model;
}

// Tests that other leakages are also found, whatever the model's own are: the fit needs no guess.
TEST(LeakageFitTest, OtherLeakages) {
  for (const auto& [c_E, c_I] : {std::pair(1.5e-6, 7e-6), std::pair(4e-5, 2e-5), std::pair(7e-7, 3e-7)}) {
    const LeakageFit fit = FitLeakage(ShippedModel("table1"), {Clamped(Leaking(c_E, c_I), 10, 1)});
    EXPECT_NEAR(fit.c_E.value, c_E, 0.05 * c_E);
    EXPECT_NEAR(fit.c_I.value, c_I, 0.05 * c_I);
    EXPECT_THAT(fit.not_identifiable, IsEmpty());
  }
}

// Tests that the 95 % intervals are honest: over 40 draws of the noise they hold the truth 35 times or more
// (which has a probability of 0.986 at 95 %), and their width matches the scatter of the values.
TEST(LeakageFitTest, IntervalsAreHonest) {
  const int draws = 40;
  const runs::MeasuredRun clean = Clamped(ShippedModel("table1"), 10, 1, 1e-9);
  int c_E_held = 0, c_I_held = 0;
  double squares = 0, half = 0;
  for (int seed = 1; seed <= draws; ++seed) {
    runs::MeasuredRun run = clean;
    for (size_t i = 0; i < run.samples(); ++i) {
      run.p1.values[i] += 3 * plant::StandardNormal(static_cast<uint64_t>(seed), static_cast<int64_t>(i), 0);
      run.p2.values[i] += 3 * plant::StandardNormal(static_cast<uint64_t>(seed), static_cast<int64_t>(i), 1);
    }
    run.p1.noise = run.p2.noise = 3;
    const LeakageFit fit = FitLeakage(ShippedModel("table1"), {run});
    c_E_held += fit.c_E.low <= 6.5e-6 && 6.5e-6 <= fit.c_E.high;
    c_I_held += fit.c_I.low <= 1e-6 && 1e-6 <= fit.c_I.high;
    squares += std::pow(fit.c_I.value - 1e-6, 2);
    half = fit.c_I.half_width();
  }
  EXPECT_GE(c_E_held, 35);
  EXPECT_GE(c_I_held, 35);
  EXPECT_NEAR(1.96 * std::sqrt(squares / draws) / half, 1, 0.34);  // 3 sqrt(1/(2 draws))
}

// Tests that data which tell only one combination are reported as such: pressures recorded long after the
// last stick, when one side stays at p_3 and the pump creeps steadily against c_E + c_I.
TEST(LeakageFitTest, SteadyCreepTellsOnlyTheSum) {
  runs::MeasuredRun run = Clamped(ShippedModel("table1"), 10, 1, 3, 3200);
  for (size_t i = 0; i < run.samples(); ++i) {
    // The swing about the creep has a time constant of 1.8 s from 1.3 s on; the torque ends at 14 s.
    if (run.time[i] > 12 && run.time[i] < 13.9) continue;
    run.p1.values[i] = run.p2.values[i] = std::numeric_limits<double>::quiet_NaN();
  }
  // One sample of the rest before, so that the pressures are seen to move.
  run.p1.values[10] = 100;
  run.p2.values[10] = 100;
  const LeakageFit fit = FitLeakage(ShippedModel("table1"), {run});
  EXPECT_THAT(fit.not_identifiable, ElementsAre("c_E", "c_I"));
  // It still contains a trace of the swing, which knows c_E + 2 c_I from the sticks.
  EXPECT_NEAR(fit.information.c_I_weight, 1, 0.3);
  EXPECT_LT(fit.combination.low, 6.5e-6 + fit.information.c_I_weight * 1e-6);
  EXPECT_GT(fit.combination.high, 6.5e-6 + fit.information.c_I_weight * 1e-6);
  EXPECT_LT(fit.information.correlation, -0.9);
}

// Tests that the fit needs no given noise, and tolerates missing values and uneven times.
TEST(LeakageFitTest, UnknownNoiseGapsUnevenTimes) {
  runs::MeasuredRun run = Clamped(ShippedModel("table1"), -10, 1);
  run.p1.noise = run.p2.noise = std::nullopt;
  runs::MeasuredRun uneven = run;
  uneven.time.clear();
  uneven.voltage.values.clear();
  uneven.p1.values.clear();
  uneven.p2.values.clear();
  for (size_t i = 0; i < run.samples(); ++i) {
    if (i % 5 == 3 && run.voltage.values[i] == run.voltage.values[i - 1]) continue;
    uneven.time.push_back(run.time[i]);
    uneven.voltage.values.push_back(run.voltage.values[i]);
    uneven.p1.values.push_back(i % 11 == 0 ? std::nan("") : run.p1.values[i]);
    uneven.p2.values.push_back(run.p2.values[i]);
  }
  const LeakageFit fit = FitLeakage(ShippedModel("table1"), {uneven});
  EXPECT_NEAR(fit.c_E.value, 6.5e-6, 0.05 * 6.5e-6);
  EXPECT_NEAR(fit.c_I.value, 1e-6, 0.05 * 1e-6);
  EXPECT_NEAR(fit.p1_noise[0], 3, 0.5);
}

std::string ErrorOf(const runs::MeasuredRun& run) {
  try {
    FitLeakage(ShippedModel("table1"), {run});
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError was thrown";
  return {};
}

// Tests each way in which a run can fail to support the fit: the message says what was found and what is
// allowed.
TEST(LeakageFitTest, Errors) {
  const runs::MeasuredRun good = Clamped(ShippedModel("table1"), 10, 1);
  runs::MeasuredRun run = good;
  run.shaft = model::Shaft::kFree;
  EXPECT_THAT(ErrorOf(run),
              AllOf(HasSubstr("clamped.csv: found a shaft that is free"), HasSubstr("allowed")));
  run = good;
  run.bypass = true;
  EXPECT_THAT(ErrorOf(run), HasSubstr("found the bypass open"));
  run = good;
  run.p1 = {};
  EXPECT_THAT(ErrorOf(run), HasSubstr("found no p1, allowed a run with p1 and p2"));
  run = good;
  run.p2 = {};
  EXPECT_THAT(ErrorOf(run), HasSubstr("found no p2"));
  EXPECT_THAT(ErrorOf(Clamped(ShippedModel("table1"), 3.9, 1)),
              HasSubstr("found a motor torque of at most 3.9 in-lbf, which friction holds (T_s = 4 in-lbf)"));
  EXPECT_THAT(ErrorOf(Clamped(ShippedModel("table1"), 4.01, 1)),
              AllOf(HasSubstr("found p_2 - p_1 from"), HasSubstr("ten times the noise")));
  run = good;
  for (size_t i = 0; i < 50; ++i) run.p2.values[i] += 300;
  EXPECT_THAT(ErrorOf(run), HasSubstr("found a start at p_1 = "));
  run = good;
  std::swap(run.p1, run.p2);
  EXPECT_THAT(ErrorOf(run), AllOf(HasSubstr("found p_2 - p_1 against the sign of the voltage"),
                                  HasSubstr("exchange p1 and p2")));
  run = good;
  run.arm_angle_rad = 1.5;
  EXPECT_THAT(ErrorOf(run), AllOf(HasSubstr("clamped.csv: "), HasSubstr("V_1")));
}

// Tests that a file with its sidecar is analysed like a run of the simulated rig, and that the real recording
// of a moving piston is refused with the reason.
TEST(LeakageRunFile, TableWithSidecar) {
  const std::string stem = testing::TempDir() + "/leakage_run_file";
  const runs::MeasuredRun run = Clamped(ShippedModel("table1"), 10, 1);
  tables::Table table;
  table.columns = {{"t", run.time}, {"v", run.voltage.values}, {"a", run.p1.values}, {"b", run.p2.values}};
  tables::WriteTable(table, stem + ".csv");
  std::ofstream(stem + ".toml") << "name = \"bench\"\nshaft = \"clamped\"\n[columns]\ntime = \"t\"\n"
                                   "voltage = \"v\"\np1 = \"a\"\np2 = \"b\"\n";
  ExperimentOptions options;
  options.measured_run = stem + ".csv";
  const ExperimentResult result = RunLeakage(options);
  EXPECT_NEAR(ParseJson(result.numbers).at("c_E"), 6.5e-6, 0.05 * 6.5e-6);
  EXPECT_NEAR(ParseJson(result.numbers).at("c_I"), 1e-6, 0.05 * 1e-6);
  EXPECT_THAT(result.conditions, HasSubstr("bench"));
  EXPECT_THAT(result.findings, IsEmpty());
  EXPECT_TRUE(ParseJson(result.numbers).at("model_describes_run"));

  // Pressures on a wrong scale: numbers come out, together with the warning that they mean nothing.
  std::ofstream(stem + ".toml") << "shaft = \"clamped\"\n[columns]\ntime = \"t\"\nvoltage = \"v\"\n"
                                   "p1 = { column = \"a\", scale = 1.1, offset = -10.0 }\n"
                                   "p2 = { column = \"b\", scale = 1.1, offset = -10.0 }\n";
  const ExperimentResult wrong = RunLeakage(options);
  EXPECT_FALSE(ParseJson(wrong.numbers).at("model_describes_run"));
  EXPECT_THAT(wrong.explanation, HasSubstr("NEITHER is to be believed"));
}

// Tests that a real run whose shaft a test machine drives is refused.
TEST(LeakageRunFile, DrivenShaft) {
  const std::string stem = testing::TempDir() + "/leakage_driven";
  ExperimentOptions options;
  options.measured_run = stem + ".csv";
  const std::filesystem::path data = std::filesystem::path(HYDRO_MEASURED_DATA) / "buoy_pto";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no measured data at " << data;
  std::filesystem::copy_file(data / "sine_moves_2021-07-26.csv", stem + ".csv",
                             std::filesystem::copy_options::overwrite_existing);
  std::ofstream(stem + ".toml")
      << "shaft = \"driven\"\n[columns]\ntime = \"time(s)\"\nvoltage = \"WindCurr(A)\"\n"
         "arm_angle = \"Pos(in)\"\np1 = \"LowerHydPress(psig)\"\n"
         "p2 = \"UpperHydPress(psig)\"\n";
  try {
    RunLeakage(options);
    ADD_FAILURE() << "no InputError was thrown";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("leakage_driven.csv: found a shaft that is driven, allowed a clamped one"));
  }
}

}  // namespace
}  // namespace hydro::experiments
