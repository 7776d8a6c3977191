#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/figures/catalogue.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/position_loop.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

// Runs each figure once and keeps its numbers.
struct Figures {
  ExperimentResult fig8 = RunFig8({});
  ExperimentResult fig9 = RunFig9({});
  ExperimentResult fig10 = RunFig10({});
  json numbers8 = ParseJson(fig8.numbers);
  json numbers9 = ParseJson(fig9.numbers);
  json numbers10 = ParseJson(fig10.numbers);
};
const Figures& Outcome() {
  static const Figures figures;
  return figures;
}

// Tests that Figures 8 and 9 give the critical gain and the poles at g = 350 under the published keys.
TEST(PositionFigures, CriticalGainAndPoles) {
  for (const json* numbers : {&Outcome().numbers8, &Outcome().numbers9}) {
    EXPECT_NEAR((*numbers)["critical_gain"], 759.8, 0.05);
    EXPECT_NEAR((*numbers)["critical_frequency_rad_s"], 134, 0.5);
    const auto poles = (*numbers)["poles_at_350"].get<std::vector<std::array<double, 2>>>();
    ASSERT_EQ(poles.size(), 4u);
    EXPECT_NEAR(poles[0][0], -38.5, 0.1);
    EXPECT_NEAR(poles[0][1], 113, 0.1);
    EXPECT_NEAR(poles[3][0], -36.6, 0.1);
    EXPECT_NEAR(poles[3][1], -35.8, 0.1);
  }
  EXPECT_NEAR(Outcome().numbers9["printed_ratio"]["critical_gain"], 724.7, 0.05);
}

// Tests that Figure 8 says where its model comes from and how the free arm changes it.
TEST(PositionFigures, DesignModelAgainstTheExactOne) {
  const json& linearised = Outcome().numbers8["linearised"]["both_sides"];
  EXPECT_NEAR(linearised["natural_frequency_rad_s"], 150, 0.5);
  EXPECT_NEAR(linearised["damping_ratio"], 0.5, 0.002);
  const json& free = Outcome().numbers8["free_arm"];
  EXPECT_NEAR(free["reflected_inertia_lb_in_s2"], 6430, 10);
  EXPECT_EQ(free["arm_inertia_lb_in_s2"], 23.3);
  // The slow pole settles to 2 % in about 4 time constants: the 1.6 to 1.8 s of the full model.
  EXPECT_NEAR(4 / -free["poles_at_350"][3][0].get<double>(), 1.6, 0.1);
  EXPECT_NE(Outcome().fig8.pictures[0].figure.drawing.find("22500"), std::string::npos);
  ASSERT_EQ(Outcome().fig8.pictures.size(), 3u);
}

// Tests that the sampled loop has the right overshoot at each interval and in each form, is unstable at 10
// ms, and that simulation confirms the largest stable interval.
TEST(PositionFigures, SampledLoop) {
  const json& numbers = Outcome().numbers9;
  EXPECT_NEAR(numbers["continuous"]["on_measurement"]["overshoot_percent"], 4.3, 0.05);
  EXPECT_NEAR(numbers["continuous"]["on_error"]["overshoot_percent"], 53, 0.5);
  const double on_measurement[] = {3.5, 5.5, 17}, on_error[] = {61, 70, 99};
  for (size_t t = 0; t < 3; ++t) {
    const json& row = numbers["sampled"][t];
    EXPECT_TRUE(row["stable"]);
    EXPECT_NEAR(row["on_measurement"]["overshoot_percent"], on_measurement[t], t < 2 ? 0.05 : 0.5);
    EXPECT_NEAR(row["on_error"]["overshoot_percent"], on_error[t], 0.5);
  }
  EXPECT_FALSE(numbers["sampled"][3]["stable"]);
  EXPECT_EQ(numbers["sampled"][3]["sample_interval_s"], 0.010);
  for (const char* form : {"on_error", "on_measurement"}) {
    EXPECT_NEAR(numbers["largest_stable_interval_s"][form], 0.00960, 0.00001);
    EXPECT_TRUE(numbers["largest_stable_interval_confirmed_by_simulation"][form]);
  }
}

// Tests that both models of Figure 10 move as found: the linear one fast, the full one slowly, to where
// friction holds it.
TEST(PositionFigures, StepOfBothModels) {
  const json& numbers = Outcome().numbers10;
  EXPECT_NEAR(numbers["linear"]["overshoot_percent"], 61, 0.5);
  EXPECT_NEAR(numbers["derivative_on_measurement"]["linear"]["overshoot_percent"], 3.5, 0.05);
  EXPECT_NEAR(numbers["derivative_on_measurement"]["linear"]["settling_time_s"], 0.12, 0.005);
  EXPECT_NEAR(numbers["linear"]["steady_state_error_rad"], 0, 1e-9);
  const double settling = numbers["nonlinear"]["settling_time_s"];
  EXPECT_GE(settling, 1.6);
  EXPECT_LE(settling, 1.8);
  EXPECT_EQ(numbers["nonlinear"]["overshoot_percent"], 0);
  // The step saturates the motor in either form of the derivative.
  EXPECT_LT(numbers["largest_difference_of_derivative_forms_rad"], 1e-9);
  // T_s/(k_1 k_p c_1) = 4/(4 * 0.1336 * 10500), approached as exp(-2.5 t) for 5 s.
  EXPECT_NEAR(numbers["nonlinear"]["steady_state_error_rad"], -4 / (4 * 0.1336 * 10500), 1e-6);
}

// Tests that the causes are told apart: saturation and friction hardly matter, the pump speed does, and
// without the arm's flow the full model is the linear one.
TEST(PositionFigures, Causes) {
  const json& causes = Outcome().numbers10["causes"];
  for (const char* slow : {"all_on", "no_friction", "no_saturation", "no_friction_no_saturation"}) {
    EXPECT_NEAR(causes[slow]["settling_time_s"], 1.7, 0.2) << slow;
  }
  EXPECT_NEAR(causes["no_friction_no_saturation"]["settling_time_s"],
              Outcome().numbers10["exact_linearisation"]["settling_time_s"], 0.02);
  const double overshoot = causes["arm_speed_feedforward"]["overshoot_percent"];
  EXPECT_GE(overshoot, 39);
  EXPECT_LE(overshoot, 49);
  EXPECT_NEAR(causes["arm_speed_feedforward"]["settling_time_s"], 1, 0.1);
  EXPECT_NEAR(causes["feedforward_no_friction_no_saturation"]["overshoot_percent"],
              Outcome().numbers10["exact_linearisation_with_arm_speed_feedforward"]["overshoot_percent"],
              1.5);
  // The stack adds a tick's delay and its hold to the linear model.
  EXPECT_NEAR(causes["no_arm_flow"]["overshoot_percent"], 3.5, 0.6);
  EXPECT_NEAR(causes["no_arm_flow"]["settling_time_s"], 0.118, 0.002);
}

// Tests that the shipped retuned loop is what the search finds, and settles within 1.3 times the shortest
// time that torque and speed allow, within the motor's speed.
TEST(PositionFigures, RetunedLoop) {
  const json& numbers = Outcome().numbers10;
  const double shortest = numbers["bang_bang"]["settling_time_s"];
  EXPECT_LT(shortest, numbers["bang_bang"]["rest_to_rest_time_s"]);
  EXPECT_GE(numbers["retuned"]["settling_time_s"], shortest);
  EXPECT_LE(numbers["retuned"]["settling_time_s"], 1.3 * shortest);
  EXPECT_LT(numbers["retuned"]["overshoot_percent"], 2);
  EXPECT_LT(numbers["retuned"]["highest_motor_speed_rad_s"], 628.3);
  EXPECT_GT(numbers["retuned"]["saturated_time_s"], 0.8 * shortest);
  EXPECT_TRUE(numbers["retuned"]["found_by_search"]);
  // A straight switching line fits one step; others, and noisy ones, must still settle in reasonable time.
  ASSERT_EQ(numbers["robustness"].size(), 6u);
  for (const json& row : numbers["robustness"]) {
    if (row["gravity"]) continue;
    EXPECT_LT(row["settling_to_shortest"], 1.8) << row;
    EXPECT_GE(row["settling_to_shortest"], 1) << row;
  }
}

// Tests that gravity holds the arm below its target as statics predict: k_2 dp = m g l cos(alpha), c_1 e = dp
// with the feed-forward, within the friction band of T_s.
TEST(PositionFigures, GravityError) {
  const model::Parameters p = ShippedModel("table1_gravity").parameters;
  const json& row = Outcome().numbers10["robustness"][5];
  ASSERT_TRUE(row["gravity"]);
  const double error = row["steady_state_error_rad"];
  const double dp = p.mgl * std::cos(0.1 + error) / p.k_2;
  const double band = 4 / (4 * 0.1366);  // psi, T_s/(k_1 (k_p + feed-forward))
  EXPECT_LT(-error * 10000, dp + 1.02 * band);
  EXPECT_GT(-error * 10000, dp - 1.02 * band);
  EXPECT_NEAR(error, Outcome().numbers10["gravity_error_closed_form_rad"], 0.01 * std::fabs(error));
}

// Tests that every finding that these figures support is there, and that every picture has a caption.
TEST(PositionFigures, FindingsAndPictures) {
  ASSERT_EQ(Outcome().fig9.findings.size(), 2u);
  EXPECT_EQ(Outcome().fig9.findings[0].number, 5);
  EXPECT_EQ(Outcome().fig9.findings[1].number, 7);
  ASSERT_EQ(Outcome().fig10.findings.size(), 1u);
  EXPECT_EQ(Outcome().fig10.findings[0].number, 8);
  for (const ExperimentResult* result : {&Outcome().fig8, &Outcome().fig9, &Outcome().fig10}) {
    ASSERT_FALSE(result->pictures.empty());
    EXPECT_EQ(result->pictures[0].suffix, "");
    for (const Picture& picture : result->pictures) EXPECT_FALSE(picture.figure.caption.empty());
    EXPECT_GT(result->table.rows(), 100u);
  }
}

// Tests that the search's short cut moves the arm as the stack does.
TEST(StepTrial, EqualsTheStack) {
  const std::string config =
      ShippedStackText("retuned", {"reference.steps=[[0.1, 0.1]]", "time.duration_s=0.6"});
  tune::StepTrial trial = TrialOf(config, ShippedModelText("table1"), 0.1);
  trial.duration = 0.5;
  const design::Response response = tune::RunStepTrial(trial).response;
  const tables::Table table = RunStackInProcess({"trial", config, ShippedModelText("table1")});
  const tables::Column* angle = table.Find("arm_angle_rad");
  ASSERT_NE(angle, nullptr);
  const size_t start = 500;  // ticks before the step
  for (size_t i = 0; i < response.angle.size(); ++i) {
    ASSERT_NEAR(response.angle[i], angle->values[start + i], 1e-9) << i;
  }
}

}  // namespace
}  // namespace hydro::experiments
