// The Monte Carlo of Figure 10's retuned loop.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/figures/catalogue.h"
#include "experiments/figures/fig10_runs.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/uncertain_machines.h"
#include "model/terms/description.h"
#include "model/terms/parameter_info.h"

namespace hydro::experiments {
namespace {

constexpr int kMachines = 600;

ExperimentResult Uncertain(int machines, int jobs, int64_t seed = 1) {
  ExperimentOptions options;
  options.machines = machines;
  options.jobs = jobs;
  options.seed = seed;
  return RunFig10Uncertainty(options);
}

const ExperimentResult& Outcome() {
  static const ExperimentResult result = Uncertain(kMachines, 2);
  return result;
}

const std::vector<double>& Column(const ExperimentResult& result, const char* name) {
  return result.table.Find(name)->values;
}

// Tests that threads change no bit, that a machine is the same among few and among many, and that another
// seed draws others.
TEST(Fig10Uncertainty, DependsOnSeedAlone) {
  const ExperimentResult few = Uncertain(kMachines / 4, 5);
  for (const tables::Column& column : few.table.columns) {
    const std::vector<double>& among_many = Column(Outcome(), column.name.c_str());
    for (size_t i = 0; i < column.values.size(); ++i) {
      ASSERT_TRUE(column.values[i] == among_many[i] || std::isnan(column.values[i]))
          << column.name << ' ' << i;
    }
  }
  EXPECT_EQ(few.numbers, Uncertain(kMachines / 4, 1).numbers);
  EXPECT_NE(few.numbers, Uncertain(kMachines / 4, 2, 2).numbers);
}

// Tests that the machines are those of the draw, and that Table 1's own step is Figure 10's.
TEST(Fig10Uncertainty, StepsTheDrawnMachines) {
  const tune::StepTrial trial = RetunedTrial(kFigure10Step, 2);
  for (const size_t machine : {size_t{0}, size_t{17}, size_t{kMachines - 1}}) {
    const model::ModelDescription drawn = model::DrawnModel(trial.model, 1, machine);
    for (const model::BaseParameter& parameter : model::BaseParameters()) {
      EXPECT_EQ(Column(Outcome(), parameter.info.name.c_str())[machine], drawn.parameters.*parameter.member);
    }
    const UncertainStep step = StepOf(trial, drawn);
    EXPECT_EQ(step.settling, Column(Outcome(), "settling_time_s")[machine]);
    EXPECT_EQ(step.overshoot_percent, Column(Outcome(), "overshoot_percent")[machine]);
  }
  const nlohmann::json numbers = ParseJson(Outcome().numbers);
  const nlohmann::json fig10 = ParseJson(RunFig10({}).numbers)["retuned"];
  EXPECT_NEAR(numbers["settling_time_s"]["table_1"], fig10["settling_time_s"], 1e-9);
  EXPECT_NEAR(numbers["overshoot_percent"]["table_1"], fig10["overshoot_percent"], 1e-6);
}

// Tests that no machine is faster than its motor allows.
TEST(Fig10Uncertainty, IsNeverFasterThanTheMotor) {
  const std::vector<double>&settling = Column(Outcome(), "settling_time_s"),
        &shortest = Column(Outcome(), "shortest_settling_time_s");
  ASSERT_EQ(settling.size(), size_t{kMachines});
  for (size_t i = 0; i < settling.size(); ++i) {
    EXPECT_FALSE(settling[i] <= shortest[i]) << i;  // NaN: never
  }
}

// Tests the numbers: quantiles in order, shares as the table has them, the worst machines, and that D comes
// first.
TEST(Fig10Uncertainty, SumsUp) {
  const nlohmann::json numbers = ParseJson(Outcome().numbers);
  const auto settling = numbers["settling_time_s"];
  EXPECT_LT(settling["lowest"], settling["p5"]);
  EXPECT_LT(settling["p5"], settling["p50"]);
  EXPECT_LT(settling["p50"], settling["p95"]);
  EXPECT_LT(settling["p95"], settling["p99"]);
  const std::vector<double>& overshoot = Column(Outcome(), "overshoot_percent");
  const auto many = std::count_if(overshoot.begin(), overshoot.end(), [](double o) { return o > 5; });
  EXPECT_EQ(numbers["overshoots_by_more_than_5_percent"]["share"], static_cast<double>(many) / kMachines);
  EXPECT_EQ(numbers["most_overshoot"][0]["overshoot_percent"],
            *std::max_element(overshoot.begin(), overshoot.end()));
  const nlohmann::json& first = numbers["influences"][0];
  EXPECT_EQ(first["parameter"], "D");
  EXPECT_GT(first["settling_time"]["variance_share"], 0.4);
  EXPECT_GT(first["overshoot"]["variance_share"], 0.7);
  EXPECT_GT(first["overshoot"]["rank_correlation"], 0.7);
  EXPECT_EQ(numbers["influences"].size(), 14u);  // all but f and m g l, which are 0
}

// Tests the reason given for machines that never settle: friction holds the arm where the closed form says it
// can, and not much below.
TEST(Fig10Uncertainty, FrictionKeepsFromSettling) {
  const tune::StepTrial trial = RetunedTrial(kFigure10Step, 2);
  const double gain =
      (trial.pressure.gains.k_p + trial.pressure.reference_feedforward) * trial.position.c1;  // V/rad
  const auto step_with = [&](double held) {  // rad, where friction can hold the arm
    model::ModelDescription machine = trial.model;
    machine.parameters.T_s = held * gain * machine.parameters.k_1;
    machine.parameters.D *= 0.9;  // creeps in from below
    return StepOf(trial, machine);
  };
  EXPECT_TRUE(step_with(0.9 * 0.02 * trial.step).settles());
  const UncertainStep held = step_with(1.15 * 0.02 * trial.step);
  EXPECT_FALSE(held.settles());
  EXPECT_LT(std::fabs(held.final_error), 1.15 * 0.02 * trial.step);
}

// Tests that progress rises to 1 and that each picture draws.
TEST(Fig10Uncertainty, ReportsProgress) {
  ExperimentOptions options;
  options.machines = 60;
  options.jobs = 3;
  double last = 0;
  options.progress = [&](double done) {
    EXPECT_GE(done, last);
    last = done;
  };
  const ExperimentResult result = RunFig10Uncertainty(options);
  EXPECT_EQ(last, 1);
  ASSERT_EQ(result.pictures.size(), 3u);
  for (const Picture& picture : result.pictures) EXPECT_FALSE(picture.figure.panels.empty());
}

}  // namespace
}  // namespace hydro::experiments
