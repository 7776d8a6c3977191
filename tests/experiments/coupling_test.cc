// Two joints in one arm: the torques that couple them against the textbook's, and errors against what
// feedback must pay for them.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/figures/catalogue.h"
#include "experiments/studies/coupling_study.h"
#include "experiments/studies/experiment.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

const ExperimentResult& Result() {
  static const ExperimentResult result = RunCoupling({});
  return result;
}
const json& Numbers() {
  static const json numbers = ParseJson(Result().numbers);
  return numbers;
}
double At(const std::string& pointer) { return Numbers().at(json::json_pointer(pointer)).get<double>(); }

// Tests the loads that the joints' own models have: inertia and weight about each joint, the arm bent by 0.8
// rad.
TEST(Coupling, OwnModels) {
  const double g = 386.09, m1 = 12 / g, m2 = 8 / g, hand = 15 / g;
  const double about_elbow = 0.5 + m2 * 7 * 7 + hand * 16 * 16;
  const double moment = m2 * 7 + hand * 16;
  EXPECT_NEAR(At("/own_model/forearm/J_a_lbf_in_s2"), about_elbow, 1e-9);
  EXPECT_NEAR(At("/own_model/upper_arm/J_a_lbf_in_s2"),
              1 + m1 * 81 + (m2 + hand) * 400 + about_elbow + 2 * 20 * moment * std::cos(0.8), 1e-9);
  EXPECT_NEAR(At("/own_model/forearm/mgl_in_lbf"), g * moment * std::cos(0.4), 1e-9);
}

// Tests that the resting joint's actuator gives the torque that the textbook's two links ask for, within 2 %:
// the angles of the run are those of the reference within 1 mrad.
TEST(Coupling, TorqueAtTheRestingJointIsTheTextbooks) {
  const double forearm = At("/cases/upper_moves/closed_form/forearm/peak_coupling_in_lbf");
  EXPECT_NEAR(At("/cases/upper_moves/coupled/inverse_dynamics/forearm/peak_coupling_in_lbf"), forearm,
              0.02 * forearm);
  const double upper = At("/cases/forearm_moves/closed_form/upper_arm/peak_coupling_in_lbf");
  EXPECT_NEAR(At("/cases/forearm_moves/coupled/inverse_dynamics/upper_arm/peak_coupling_in_lbf"), upper,
              0.02 * upper);
  // M_12 alpha_1'': the quintic's largest acceleration is 5.77 times the distance over the time squared.
  const double g = 386.09,
               M_12 = 0.5 + 8 / g * 49 + 15 / g * 256 + 20 * (8 * 7 + 15 * 16) / g * std::cos(0.8);
  const double time = std::round(1.875 * 0.4 / 0.7 / 0.01) * 0.01;
  EXPECT_NEAR(At("/cases/upper_moves/closed_form/forearm/peak_of_inertia_in_lbf"),
              M_12 * 5.7735 * 0.4 / (time * time), 0.01);
}

// Tests that a joint which knows only itself errs by the coupling torque over its stiffness, give or take the
// pump's friction; that gravity takes a part away, and the whole inverse dynamics all but what a lone joint
// has.
TEST(Coupling, FeedForwardTakesItAway) {
  const double band = At("/friction_band_in_lbf") / At("/stiffness_in_lbf_per_rad");
  const auto error = [](const std::string& kind) {
    return At("/cases/both_move/" + kind + "/forearm/peak_angle_error_rad");
  };
  EXPECT_NEAR(error("coupled/own"), At("/cases/both_move/closed_form/forearm/angle_error_at_peak_rad"),
              0.3 * band);
  EXPECT_LT(error("coupled/gravity"), 0.6 * error("coupled/own"));
  EXPECT_LT(error("coupled/inverse_dynamics"), 0.7 * error("coupled/gravity"));
  EXPECT_LT(error("coupled/inverse_dynamics"), 1.1 * band);
  EXPECT_LT(error("uncoupled/own"), 1.1 * band);
  EXPECT_GT(error("coupled/pd"), 5 * error("coupled/own"));
}

// Tests that two rigs in the place of the arm do not feel each other: the same numbers whether the other
// moves or not.
TEST(Coupling, RigsDoNotFeelEachOther) {
  EXPECT_EQ(At("/cases/upper_moves/uncoupled/own/upper_arm/peak_angle_error_rad"),
            At("/cases/both_move/uncoupled/own/upper_arm/peak_angle_error_rad"));
  EXPECT_NE(At("/cases/upper_moves/coupled/own/upper_arm/peak_angle_error_rad"),
            At("/cases/both_move/coupled/own/upper_arm/peak_angle_error_rad"));
}

// Tests that the motor is not at its limit of 40 in-lbf where feed-forward is compared.
TEST(Coupling, MotorIsNotAtItsLimit) {
  for (const Moving& moving : kCases) {
    for (const char* kind : {"own", "gravity", "inverse_dynamics"}) {
      EXPECT_LT(At("/cases/" + Name(moving) + "/coupled/" + kind + "/highest_motor_torque_in_lbf"), 39);
    }
  }
}

// Tests that the table and the pictures are there, and complete.
TEST(Coupling, TableAndPictures) {
  for (const tables::Column& column : Result().table.columns) {
    EXPECT_EQ(column.values.size(), Result().table.rows()) << column.name;
  }
  EXPECT_EQ(Result().pictures.size(), 3u);
}

}  // namespace
}  // namespace hydro::experiments
