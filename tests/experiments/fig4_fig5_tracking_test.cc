// Figures 4 and 5: the pressure loop over the stack, against reference trajectories, a loop written out here
// and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/figures/catalogue.h"
#include "experiments/runs/pressure_loop_run.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"
#include "model/actuator.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

// Table 1, and the gains of eq. (16) for omega_n = 150 rad/s, zeta = 0.5, both sides compressing.
constexpr double kK1 = 4, kD = 0.00796, kJ = 0.03, kB = 0.01455, kTs = 4, kTpmax = 40, kLeak = 7.5e-6;
constexpr double kKp = (150.0 * 150 * kJ / (2 * 247000 / 3.16 * kD) - kD) / kK1;
constexpr double kKv = (2 * 0.5 * 150 * kJ - kB) / (kK1 * kKp);

ExperimentOptions Noisy() {
  ExperimentOptions options;
  options.noise = true;
  return options;
}

const ExperimentResult& Figure4() {
  static const ExperimentResult result = RunFig4(Noisy());
  return result;
}
const json& Fig4() {
  static const json numbers = ParseJson(Figure4().numbers);
  return numbers;
}
const json& Fig5() {
  static const json numbers = ParseJson(RunFig5({}).numbers);
  return numbers;
}

// Tests that the stack without delay is the sampled loop itself: it gives the trajectory of an event-located
// integration with steps of 1e-6 s (two such agree to 2e-7 psi), 10 Hz, +/-300 psi, k_p = 0.134, k_v = 8.4.
TEST(Figure4, StackGivesTheReferenceTrajectory) {
  struct Row {
    double time, p1, p2;
  };
  constexpr Row kSquare[] = {{0.001, 100, 100.373175515},          {0.02, 100, 242.616741743},
                             {0.05, 100, 396.568239647},           {0.06, 138.577643126, 356.495094896},
                             {0.1, 429.472822425, 110.713464744},  {0.163, 219.429660639, 343.455860032},
                             {0.333, 100, 483.90458899},           {0.49, 491.487662302, 102.6648786},
                             {0.75, 136.180423988, 456.236139794}, {1, 456.241219573, 136.185391084}};
  const tables::Table table = RunStackInProcess({"square", R"([model]
file = "table1.toml"
shaft = "clamped"
[time]
mode = "lockstep"
duration_s = 1
[plant]
rate_hz = 5000
command_delay_ticks = 0
[pressure]
k_p = 0.134
k_v = 8.4
[position]
sample_interval_s = 0.0002
[reference]
signal = "pressure"
kind = "square"
amplitude = 300.0
frequency_hz = 10.0
)",
                                                 ShippedModelText("table1")});
  for (const Row& row : kSquare) {
    const auto i = static_cast<size_t>(std::lround(row.time * 5000));
    EXPECT_NEAR(table.Find("p1_psi")->values.at(i), row.p1, 1e-6) << row.time;
    EXPECT_NEAR(table.Find("p2_psi")->values.at(i), row.p2, 1e-6) << row.time;
  }
}

// Eq. (16) written out, on the model: RMS error and share of saturated ticks from 0.5 s on.
struct Own {
  double rms = 0, saturated = 0, highest = 0;
};
Own RunOwnLoop(bool square, double feedforward) {
  model::Actuator actuator(ShippedModel("table1"), {.shaft = model::Shaft::kClamped});
  Own own;
  int count = 0;
  for (int tick = 0; tick <= 5000; ++tick) {
    const double phase = std::fmod(tick / 500.0, 1);
    const double reference =
        square ? (phase < 0.5 ? 300 : -300) : 300 * std::sin(2 * std::acos(-1.0) * phase);
    const model::Measurement m = actuator.Measure();
    const double dp = m.p2 - m.p1;
    const double asked = kKp * (reference - dp - kKv * m.motor_speed) + feedforward * reference;
    const double volts = std::clamp(asked, -kTpmax / kK1, kTpmax / kK1);
    if (tick >= 2500) {
      own.rms += (reference - dp) * (reference - dp);
      own.saturated += volts != asked;
      own.highest = std::max(own.highest, dp);
      ++count;
    }
    actuator.Advance(volts, (tick + 1) / 5000.0);
  }
  own.rms = std::sqrt(own.rms / count);
  own.saturated /= count;
  return own;
}

// The feed-forward that covers D dp and the creep: per psi, k_1 feedforward = D + (b + k_1 k_p k_v) c/D.
constexpr double kPerPsi = kD + (kB + kK1 * kKp * kKv) * kLeak / kD;

void ExpectLikeOwn(const json& here, const Own& own) {
  EXPECT_NEAR(here["rms_error_psi"].get<double>(), own.rms, 1e-3);
  EXPECT_NEAR(here["saturated_fraction"].get<double>(), own.saturated, 1e-3);
  EXPECT_NEAR(here["highest_dp_psi"].get<double>(), own.highest, 1e-3);
}

// Tests error and saturation for the square wave and the sine, with and without feed-forward, against the
// loop written out above.
TEST(Tracking, LikeALoopWrittenOut) {
  ExpectLikeOwn(Fig4(), RunOwnLoop(true, 0));
  ExpectLikeOwn(Fig4()["with_feedforward"], RunOwnLoop(true, kPerPsi / kK1));
  ExpectLikeOwn(Fig5(), RunOwnLoop(false, 0));
  ExpectLikeOwn(Fig5()["with_feedforward"], RunOwnLoop(false, kPerPsi / kK1));
}

// Tests that the square wave saturates the motor: about 322 in-lbf requested at k_p = 0.134, 40 available,
// and steady peaks near +/-391 psi for a loop that acts continuously.
TEST(Figure4, Saturates) {
  EXPECT_GT(Fig4()["saturated_fraction"], 0.5);
  EXPECT_NEAR(Fig4()["demand_at_a_settled_jump_in_lbf"].get<double>(), 600 * kK1 * kKp, 1e-9);
  EXPECT_NEAR(Fig4()["demand_at_a_settled_jump_in_lbf"].get<double>(), 322, 2);
  EXPECT_GT(Fig4()["largest_torque_demand_in_lbf"], 7 * kTpmax);
  EXPECT_NEAR(Fig4()["at_50_khz"]["highest_dp_psi"].get<double>(), 391, 1.5);
  EXPECT_NEAR(Fig4()["at_50_khz"]["lowest_dp_psi"].get<double>(), -391, 1.5);
  // The cycle is the same both ways.
  EXPECT_NEAR(Fig4()["highest_dp_psi"].get<double>(), -Fig4()["lowest_dp_psi"].get<double>(), 0.01);
  for (const double torque : Figure4().table.Find("torque_in_lbf")->values) ASSERT_LE(std::abs(torque), 40);
  ASSERT_EQ(Figure4().findings.size(), 1u);
  EXPECT_EQ(Figure4().findings[0].number, 9);
  EXPECT_NE(Figure4().findings[0].evidence.find("321 in-lbf"), std::string::npos);
}

// The error that a held reference leaves: k_1 (k_p e + feedforward ref) = kPerPsi (ref - e) + T_s.
double Remains(double reference, double feedforward) {
  return (kPerPsi * reference + kTs - kK1 * feedforward * reference) / (kK1 * kKp + kPerPsi);
}

// Tests the steady-state errors with and without feed-forward against the balance of torques: the
// feed-forward removes all but Coulomb friction, and one tuned at 300 psi removes it there only.
TEST(Tracking, SteadyStateErrors) {
  for (const json* fig : {&Fig4(), &Fig5()}) {
    EXPECT_NEAR((*fig)["steady_state_error_psi"].get<double>(), Remains(300, 0), 1e-6);
    EXPECT_NEAR((*fig)["with_feedforward"]["steady_state_error_psi"].get<double>(),
                kTs / (kK1 * kKp + kPerPsi), 1e-6);
    EXPECT_NEAR((*fig)["sticking_band_psi"][0].get<double>(), (kK1 * kKp * 300 - kTs) / (kK1 * kKp + kD),
                1e-9);
    EXPECT_NEAR((*fig)["sticking_band_psi"][1].get<double>(), (kK1 * kKp * 300 + kTs) / (kK1 * kKp + kD),
                1e-9);
  }
  EXPECT_NEAR(Remains(300, 0), 14.01, 0.01);
  const double tuned = Fig4()["with_tuned_feedforward"]["feedforward_V_per_psi"];
  EXPECT_NEAR(Remains(300, tuned), 0, 1e-9);
  const auto check = [](const json& levels, double feedforward) {
    ASSERT_EQ(levels.size(), 6u);
    for (const json& level : levels) {
      EXPECT_NEAR(level["steady_state_error_psi"].get<double>(),
                  Remains(level["reference_psi"].get<double>(), feedforward), 1e-6);
    }
  };
  check(Fig4()["steady_state_by_reference"], 0);
  check(Fig4()["with_feedforward"]["steady_state_by_reference"], kPerPsi / kK1);
  check(Fig4()["with_tuned_feedforward"]["steady_state_by_reference"], tuned);
}

// Tests that the sine is followed nearly as a linear second-order loop of 150 rad/s and 0.5 does: friction,
// and valves that make one side the spring at the crests, change the first harmonic by a few per cent.
TEST(Figure5, FollowsNearlyLinearly) {
  const double ratio = 2 * std::acos(-1.0) * 10 / 150;
  const double gain = 1 / std::hypot(1 - ratio * ratio, ratio);
  const double phase = -std::atan2(ratio, 1 - ratio * ratio) * 180 / std::acos(-1.0);
  EXPECT_NEAR(Fig5()["first_harmonic"]["gain"].get<double>(), gain, 0.06 * gain);
  EXPECT_NEAR(Fig5()["first_harmonic"]["phase_deg"].get<double>(), phase, 4);
  EXPECT_EQ(Fig5()["saturated_fraction"], 0);
}

// Tests that noise is an option: a picture and figures of its own, the others unchanged.
TEST(Figure4, NoiseIsAnOption) {
  ASSERT_EQ(Figure4().pictures.size(), 3u);
  EXPECT_EQ(Figure4().pictures[0].suffix, "");
  EXPECT_EQ(Figure4().pictures[1].suffix, "-noise");
  const json& noisy = Fig4()["with_noise"];
  EXPECT_EQ(noisy["pressure_noise_psi"], 15);
  // dp is measured with sqrt(2) 15 psi, which adds to the error's square.
  EXPECT_NEAR(noisy["rms_error_psi"].get<double>(),
              std::sqrt(std::pow(Fig4()["rms_error_psi"].get<double>(), 2) + 2 * 15 * 15), 3);
  EXPECT_FALSE(Fig5().contains("with_noise"));
  EXPECT_EQ(ParseJson(RunFig4(Noisy()).numbers), Fig4());  // bit-identical
}

}  // namespace
}  // namespace hydro::experiments
