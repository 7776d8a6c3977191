// Figure 1: the numbers of the rig against hand calculations from Table 1.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/figures/catalogue.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"

namespace hydro::experiments {
namespace {

const ExperimentResult& Result() {
  static const ExperimentResult result = RunFig1({});
  return result;
}

// Tests that both ratios are Table 1's, not the printed one, and match the simulated rig.
TEST(Apparatus, Ratios) {
  const auto numbers = ParseJson(Result().numbers);
  EXPECT_NEAR(numbers["torque_ratio"], 3.68 / 0.00796, 1e-9);
  EXPECT_NEAR(numbers["torque_ratio"], 462.3, 0.05);
  EXPECT_NEAR(numbers["displacement_ratio"], 462.8, 0.05);
  EXPECT_NEAR(numbers["k_2_for_printed_ratio_in_lbf_per_psi"], 3.858, 0.0005);
  // Against leakage the pump creeps at theta' = (c_I + c_E) dp/D, which takes b theta' from the torque.
  EXPECT_NEAR(numbers["torque_ratio_measured"], 3.68 / (0.00796 + 0.01455 * 7.5e-6 / 0.00796), 0.01);
  // The free arm's angle per motor angle: leakage and compressed oil take less than 0.01 %.
  EXPECT_NEAR(numbers["displacement_ratio_measured"], 1.83 * 1.83 * 2.2 / 2 / 0.00796, 0.05);
}

// Tests torques and speeds against the printed ones.
TEST(Apparatus, TorquesAndSpeeds) {
  const auto numbers = ParseJson(Result().numbers);
  EXPECT_NEAR(numbers["peak_torque_printed_in_lbf"], 19388, 0.5);
  EXPECT_NEAR(numbers["peak_torque_in_lbf"], 18492.5, 0.5);
  EXPECT_NEAR(numbers["peak_torque_N_m"], 18492.5 * 0.1129848, 0.5);
  EXPECT_NEAR(numbers["torque_at_2000_psi_in_lbf"], 7360, 1e-9);
  EXPECT_NEAR(numbers["torque_at_2000_psi_above_accumulator_in_lbf"], 6992, 1e-9);
  EXPECT_NEAR(numbers["maximum_speed_printed_rpm"], 12.4, 0.05);
  // The motor's last step overshoots 6000 rpm by up to a tick of 1200 rad/s^2, 0.2 %.
  EXPECT_NEAR(numbers["maximum_speed_rpm"], 6000 / 462.79, 0.03);
  // Eqs. (1) to (15) have no speed limit: (40 - 4)/0.01455 rad/s, within e^{-30/2} of it after 30 s.
  EXPECT_NEAR(numbers["unlimited_motor_speed_rpm"], 36 / 0.01455 * 30 / M_PI, 0.1);
}

// Tests that the assumed 18000 rpm motor has the power of the other one and moves the arm the same.
TEST(Apparatus, FastMotorIsAnAssumptionOfTheSamePower) {
  const model::Parameters slow = ShippedModel("table1").parameters;
  const model::Parameters fast = ShippedModel("motor_18000rpm").parameters;
  EXPECT_NEAR(fast.T_pmax * 18000, slow.T_pmax * 6000, 1e-6);
  EXPECT_NEAR(fast.T_pmax / fast.k_1, slow.T_pmax / slow.k_1, 1e-9);
  EXPECT_NEAR(fast.J, slow.J * std::pow(1.0 / 3, 5.0 / 3), 1e-6);
  for (const double ratio :
       {slow.D / fast.D, slow.b / fast.b, slow.T_s / fast.T_s, slow.c_E / fast.c_E, slow.c_I / fast.c_I}) {
    EXPECT_NEAR(ratio, 3, 1e-9);
  }
  const auto numbers = ParseJson(Result().numbers);
  EXPECT_TRUE(numbers["motor_18000rpm"]["assumption"]);
  EXPECT_NEAR(numbers["motor_18000rpm"]["maximum_speed_rpm"], 6000 / 462.79, 0.03);
  EXPECT_NE(ShippedModelText("motor_18000rpm").find("ASSUMPTION"), std::string::npos);
}

// Tests that findings 2 and 6 have their figures, and that the schematic has the paper's symbols.
TEST(Apparatus, FindingsAndSchematic) {
  ASSERT_EQ(Result().findings.size(), 2u);
  EXPECT_EQ(Result().findings[0].number, 2);
  for (const char* figure : {"462.3", "462.8", "3.858"}) {
    EXPECT_NE(Result().findings[0].evidence.find(figure), std::string::npos) << figure;
  }
  EXPECT_EQ(Result().findings[1].number, 6);
  EXPECT_NE(Result().findings[1].evidence.find("562"), std::string::npos);
  const std::string& drawing = Result().pictures.at(0).figure.drawing;
  for (const char* symbol :
       {"accumulator p", "pump D", "bypass", "D θ&#39;", "J<tspan", "0.00796", "247000"}) {
    EXPECT_NE(drawing.find(symbol), std::string::npos) << symbol;
  }
}

}  // namespace
}  // namespace hydro::experiments
