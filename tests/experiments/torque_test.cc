// Torque control: errors against torque balances written out here, bandwidth against the linear loop.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/figures/catalogue.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/torque_runs.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

// Table 1, and the gains of eq. (16) for omega_n = 150 rad/s, zeta = 0.5, both sides compressing.
constexpr double kK1 = 4, kK2 = 3.68, kD = 0.00796, kJ = 0.03, kB = 0.01455, kTs = 4, kLeak = 7.5e-6;
constexpr double kC = 1.83 * 1.83 * 2.2 / 2;
constexpr double kKp = (150.0 * 150 * kJ / (2 * 247000 / 3.16 * kD) - kD) / kK1;
constexpr double kKv = (2 * 0.5 * 150 * kJ - kB) / (kK1 * kKp);

const ExperimentResult& Result() {
  static const ExperimentResult result = RunTorque({});
  return result;
}
const json& Numbers() {
  static const json numbers = ParseJson(Result().numbers);
  return numbers;
}

// Tests what is left of a step of the commanded torque against the clamped arm: an error that covers D dp,
// the creep against leakage, and friction; with the feed-forward, friction alone.
TEST(Torque, ClampedSteps) {
  constexpr double kPerPsi = kD + (kB + kK1 * kKp * kKv) * kLeak / kD;
  const json& clamped = Numbers()["clamped"];
  ASSERT_EQ(clamped["steps"].size(), 4u);
  for (const json& step : clamped["steps"]) {
    const double reference = step["command_in_lbf"].get<double>() / kK2;
    EXPECT_NEAR(step["steady_state_error_in_lbf"].get<double>(),
                kK2 * (kPerPsi * reference + kTs) / (kK1 * kKp + kPerPsi), 1e-5)
        << step;
    EXPECT_LT(step["settling_time_s"], 0.12) << step;
  }
  for (const json& step : clamped["steps_with_feedforward"]) {
    EXPECT_NEAR(step["steady_state_error_in_lbf"].get<double>(), kK2 * kTs / (kK1 * kKp + kPerPsi), 1e-5);
  }
  // A step of k_1 k_p e <= 40 in-lbf does not saturate; larger ones rise more slowly.
  EXPECT_EQ(clamped["steps"][0]["saturated_fraction_of_first_100_ms"], 0);
  EXPECT_GT(clamped["steps"][3]["rise_time_s"], 1.5 * clamped["steps"][0]["rise_time_s"].get<double>());
}

// Tests the band of torques in which a standing pump stays at rest, T_s/(k_1 k_p + D) k_2.
TEST(Torque, FrictionBand) {
  EXPECT_NEAR(Numbers()["friction_band_in_lbf"].get<double>(), kK2 * kTs / (kK1 * kKp + kD), 1e-9);
  // D is small beside k_1 k_p.
  EXPECT_NEAR(Numbers()["friction_band_in_lbf"].get<double>(), kK2 * kTs / (kK1 * kKp), 0.5);
}

// Tests the bandwidth at the arm: 30.4 Hz in closed form, which a sweep that hardly saturates matches up to
// the effect of friction, and far less where the motor is at its limit.
TEST(Torque, Bandwidth) {
  const double zeta2 = 2 * 0.5 * 0.5;
  const double linear =
      150 * std::sqrt(1 - zeta2 + std::sqrt((1 - zeta2) * (1 - zeta2) + 1)) / (2 * std::acos(-1.0));
  const json& clamped = Numbers()["clamped"];
  EXPECT_NEAR(clamped["linear_bandwidth_both_sides_hz"].get<double>(), linear, 1e-9);
  EXPECT_NEAR(linear, 30.4, 0.05);
  EXPECT_NEAR(clamped["linear_bandwidth_one_side_hz"].get<double>(), 16.9, 0.1);
  double previous = 1e9, previous_saturated = -1;
  for (const json& sweep : clamped["sweeps"]) {
    const double bandwidth = sweep["bandwidth_hz"];
    if (sweep["amplitude_in_lbf"] == 300 && sweep["mean_in_lbf"] == 0) {
      EXPECT_NEAR(bandwidth, linear, 0.1 * linear);
    }
    if (sweep["mean_in_lbf"] != 0 || sweep["amplitude_in_lbf"] < 300) continue;
    EXPECT_LT(bandwidth, previous) << sweep;
    EXPECT_GT(sweep["saturated_fraction"], previous_saturated) << sweep;
    previous = bandwidth;
    previous_saturated = sweep["saturated_fraction"];
  }
  EXPECT_LT(previous, 0.5 * linear);
}

// Tests the torque error as the arm passes mid-stroke at its largest speed, where it does not accelerate:
// k_1 k_p (e - k_v w) = b theta' + T_s + D dp with theta' = (c/D) alpha' and the leakage; w is all of theta',
// or with the feed-forward the leakage's part only. The pressure still changes there (the command does), and
// the loop has a lag of some ms: 3 % of the k_v term, 25 in-lbf with the feed-forward at the highest speed.
TEST(Torque, ErrorAlongThePath) {
  const double command = 562 / kK2;  // psi, at alpha = 0
  const auto expected = [&](double arm_speed, bool with) {
    double dp = command;
    for (int i = 0; i < 50; ++i) {
      const double leak = kLeak * dp / kD;
      const double forced = kC / kD * arm_speed;
      const double e =
          (kB * (forced + leak) + kTs + kD * dp) / (kK1 * kKp) + kKv * (with ? leak : forced + leak);
      dp += 0.5 * (command - e - dp);
    }
    return kK2 * (command - dp);
  };
  const json& along = Numbers()["along_path"];
  for (const json& path : along["without_arm_speed_feedforward"]) {
    const double speed = path["largest_arm_speed_rad_s"];
    const double error = path["error_at_largest_speed_in_lbf"];
    EXPECT_NEAR(error, expected(speed, false), 0.002 * error) << path;
    // Nearly all of it is the k_v term.
    EXPECT_NEAR(error, kK2 * kKv * kC / kD * speed, 0.08 * error) << path;
  }
  for (const json& path : along["with_arm_speed_feedforward"]) {
    const double speed = path["largest_arm_speed_rad_s"];
    const double error = path["error_at_largest_speed_in_lbf"];
    EXPECT_NEAR(error, expected(speed, true), speed < 0.4 ? 5 : 25) << path;
    EXPECT_LE(path["largest_motor_torque_in_lbf"], 40) << path;
    EXPECT_LT(path["largest_motor_speed_rad_s"], 6000 * 2 * std::acos(-1.0) / 60) << path;
  }
  const json& slow = along["with_arm_speed_feedforward"][1];
  EXPECT_LT(slow["largest_error_in_lbf"].get<double>(),
            0.05 * along["without_arm_speed_feedforward"][1]["largest_error_in_lbf"].get<double>());
}

// Tests the path itself: it rests at its ends, speed is the angle's rate and acceleration the speed's.
TEST(SmoothPath, IsConsistent) {
  const SmoothPath path(0.1, 0.3);
  EXPECT_DOUBLE_EQ(path.angle(0), -0.1);
  EXPECT_DOUBLE_EQ(path.angle(path.duration()), -0.1);
  EXPECT_NEAR(path.angle(path.middle()), 0, 1e-15);
  EXPECT_NEAR(path.speed(path.middle()), 0.3, 0.003);
  double largest = 0;
  constexpr double kH = 1e-5;
  for (double t = 0.0005; t < path.duration(); t += 0.001) {
    EXPECT_NEAR(path.speed(t), (path.angle(t + kH) - path.angle(t - kH)) / (2 * kH), 1e-6) << t;
    EXPECT_NEAR(path.acceleration(t), (path.speed(t + kH) - path.speed(t - kH)) / (2 * kH), 1e-4) << t;
    largest = std::max(largest, path.speed(t));
  }
  EXPECT_NEAR(largest, path.speed(path.middle()), 1e-5);
}

// Tests that the table and the pictures are there, and complete.
TEST(Torque, TableAndPictures) {
  for (const tables::Column& column : Result().table.columns) {
    EXPECT_EQ(column.values.size(), Result().table.rows()) << column.name;
  }
  EXPECT_EQ(Result().pictures.size(), 4u);
}

}  // namespace
}  // namespace hydro::experiments
