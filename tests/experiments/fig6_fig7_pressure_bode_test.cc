#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "experiments/figures/catalogue.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"
#include "pressure_ctrl/law/pressure_law.h"
#include "tests/tune/design/wave_polynomial.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;
using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;

struct Ran {
  ExperimentResult result;
  json numbers;
  explicit Ran(const ExperimentResult& r) : result(r), numbers(ParseJson(r.numbers)) {}
  const json& Case(const std::string& key) const {
    for (const json& one : numbers.at("cases")) {
      if (one.at("key") == key) return one;
    }
    throw std::out_of_range(key);
  }
};
const Ran& Fig6() {
  static const Ran ran(RunFig6({}));
  return ran;
}
const Ran& Fig7() {
  static const Ran ran(RunFig7({}));
  return ran;
}
const Ran& Waves() {
  static const Ran ran(RunWaves({}));
  return ran;
}

// Closed loop of eq. (16) on eqs. (4), (13), (14), written out by hand: dp' = s theta' - a dp,
// J theta'' = k_1 v - D dp - b theta'. The voltage is held for an interval, which delays it by half of that.
Complex HandLoop(const model::Parameters& p, double stiffness, double leak,
                 const pressure_ctrl::PressureGains& g, double hz) {
  const Complex s(0, 2 * kPi * hz);
  const Complex hold = std::exp(-s * 1e-4);
  const Complex plant = (p.J * s + p.b) * (s + leak) + stiffness * p.D;
  return p.k_1 * g.k_p * stiffness * hold / (plant + p.k_1 * g.k_p * hold * (stiffness + g.k_v * (s + leak)));
}

// Largest differences of a case's points from that loop.
void ExpectHandLoop(const json& points, const model::Parameters& p, double stiffness, double leak,
                    const pressure_ctrl::PressureGains& g) {
  const auto frequency = points.at("frequency_hz").get<std::vector<double>>();
  ASSERT_GE(frequency.size(), 28u);
  for (size_t i = 0; i < frequency.size(); ++i) {
    const Complex expected = HandLoop(p, stiffness, leak, g, frequency[i]);
    EXPECT_GT(points.at("coherence")[i].get<double>(), 0.99) << frequency[i];
    EXPECT_NEAR(points.at("gain_db")[i].get<double>(), 20 * std::log10(std::abs(expected)), 0.1)
        << frequency[i];
    const double turn = points.at("phase_deg")[i].get<double>() - std::arg(expected) * 180 / kPi;
    EXPECT_NEAR(std::remainder(turn, 360), 0, 1) << frequency[i];
  }
}

pressure_ctrl::PressureGains Gains(const model::Parameters& p, double arm_angle, int sides) {
  return pressure_ctrl::DerivePressureGains(p, arm_angle, 150, 0.5, sides);
}

// Tests Figure 6's headline: bandwidth, natural frequency and damping against the paper's 32 Hz, 150 rad/s
// and .5, which the paper gives as rough values; the damping also against the design's .5 plus Coulomb
// friction by its describing function.
TEST(Fig6, HeadlineBesideThePaper) {
  const json& n = Fig6().numbers;
  EXPECT_NEAR(n.at("bandwidth_hz").get<double>(), 32, 0.12 * 32);
  EXPECT_NEAR(n.at("natural_frequency_rad_s").get<double>(), 150, 0.03 * 150);
  const model::Parameters p = ShippedModel("table1").parameters;
  const double friction =
      4 * p.T_s / (kPi * p.k_1 * Gains(p, 0, 2).k_p * n.at("amplitude_psi").get<double>());
  EXPECT_NEAR(n.at("damping_ratio").get<double>(), 0.5 / (1 - friction), 0.08 * 0.5);
  EXPECT_NEAR(n.at("design_bandwidth_hz").get<double>(), 190.8 / (2 * kPi), 0.01);
  EXPECT_GT(*std::min_element(n.at("coherence").begin(), n.at("coherence").end()), 0.98);
  EXPECT_EQ(n.at("saturated_fraction"), 0);
  EXPECT_EQ(n.at("frequency_hz").size(), n.at("gain_db").size());
}

// Tests that without friction's switching the measured points are those of the linear loop, computed by hand,
// and that the fits are the designs: two sides compressing, one, and one with gains for one.
TEST(Fig6, LinearCasesMeetTheAnalyticLoop) {
  const model::Parameters p = ShippedModel("table1").parameters;
  const double s = p.beta * p.D / p.V_ms;
  const double c = p.beta / p.V_ms;
  const json& both = Fig6().Case("no_friction");
  ExpectHandLoop(both, p, 2 * s, c * (p.c_E + 2 * p.c_I), Gains(p, 0, 2));
  EXPECT_NEAR(both.at("natural_frequency_rad_s").get<double>(), 150, 1.5);
  EXPECT_NEAR(both.at("damping_ratio").get<double>(), 0.5, 0.01);
  EXPECT_NEAR(both.at("bandwidth_hz").get<double>(), 30.4, 0.4);
  const json& one = Fig6().Case("one_sided");
  ExpectHandLoop(one, p, s, c * (p.c_E + p.c_I), Gains(p, 0, 2));
  EXPECT_NEAR(one.at("natural_frequency_rad_s").get<double>(), 150 / std::numbers::sqrt2, 1);
  EXPECT_NEAR(one.at("damping_ratio").get<double>(), 0.5 * std::numbers::sqrt2, 0.01);
  const json& own = Fig6().Case("one_sided_own_gains");
  ExpectHandLoop(own, p, s, c * (p.c_E + p.c_I), Gains(p, 0, 1));
  EXPECT_NEAR(own.at("natural_frequency_rad_s").get<double>(), 150, 1.5);
  EXPECT_NEAR(own.at("damping_ratio").get<double>(), 0.5, 0.01);
  // The linearised loop itself, sampled: closer still.
  EXPECT_LT(Fig6().numbers.at("linearised").at("worst_error_db"), 0.05);
  EXPECT_LT(Fig6().numbers.at("linearised").at("worst_error_deg"), 0.5);
}

// Tests the effect of amplitude: friction holds small ones, the torque limit large ones.
TEST(Fig6, AmplitudeFamily) {
  const auto value = [](int amplitude, const char* key) {
    return Fig6().Case("about_zero_" + std::to_string(amplitude)).at(key).get<double>();
  };
  for (const auto& [smaller, larger] : {std::pair{10, 20}, {20, 30}, {30, 60}, {60, 100}, {100, 300}}) {
    EXPECT_GT(value(smaller, "stuck_fraction"), value(larger, "stuck_fraction")) << larger;
    EXPECT_LE(value(smaller, "saturated_fraction"), value(larger, "saturated_fraction")) << larger;
  }
  EXPECT_GT(value(20, "damping_ratio"), value(30, "damping_ratio"));
  EXPECT_GT(value(30, "damping_ratio"), value(60, "damping_ratio"));
  EXPECT_LT(value(10, "low_frequency_gain"), 0.6);
  EXPECT_EQ(value(60, "saturated_fraction"), 0);
  EXPECT_GT(value(300, "saturated_fraction"), 0.3);
  // J w^2 dp/s = T_pmax: the most that the motor can do at 32 Hz.
  const model::Parameters p = ShippedModel("table1").parameters;
  const double reach = p.T_pmax * 2 * p.beta * p.D / p.V_ms / (p.J * 200 * 200);
  EXPECT_NEAR(Fig6().numbers.at("amplitude_that_torque_allows_at_32_hz_psi").get<double>(), reach, 1e-6);
  EXPECT_LT(value(300, "bandwidth_hz"), 20);
}

// Tests finding 4: the gains that follow from omega_n and zeta, to the known digits.
TEST(Fig6, FindingGains) {
  const json& gains = Fig6().numbers.at("gains");
  EXPECT_NEAR(gains.at("two_sided").at("k_p_V_per_psi").get<double>(), 0.1336, 5e-5);
  EXPECT_NEAR(gains.at("two_sided").at("k_v_psi_s_per_rad").get<double>(), 8.39, 5e-3);
  EXPECT_NEAR(gains.at("one_sided").at("k_p_V_per_psi").get<double>(), 0.269, 5e-4);
  EXPECT_NEAR(gains.at("one_sided").at("k_v_psi_s_per_rad").get<double>(), 4.17, 5e-3);
  ASSERT_EQ(Fig6().result.findings.size(), 1u);
  EXPECT_EQ(Fig6().result.findings[0].number, 4);
  EXPECT_NE(Fig6().result.findings[0].evidence.find("0.1336"), std::string::npos);
}

// Tests finding 1: Table 1 refuses pi/2, with the volume and the limit that follow from eq. (6).
TEST(Fig7, Table1RefusesAQuarterTurn) {
  ASSERT_EQ(Fig7().result.findings.size(), 1u);
  EXPECT_EQ(Fig7().result.findings[0].number, 1);
  const std::string refusal = Fig7().numbers.at("table1").at("refusal");
  EXPECT_NE(refusal.find("V_1 = -2.6"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("0.8578"), std::string::npos) << refusal;
  EXPECT_NE(Fig7().result.findings[0].evidence.find(refusal), std::string::npos);
  const double c = 1.83 * 1.83 * 2.2 / 2;
  EXPECT_NEAR(Fig7().numbers.at("table1").at("V_1_in3").get<double>(), 3.16 - c * kPi / 2, 1e-9);
  EXPECT_NEAR(Fig7().numbers.at("table1").at("arm_angle_limit_rad").get<double>(), 0.858, 5e-4);
  EXPECT_NE(Fig7().result.conditions.find("ASSUMED"), std::string::npos);
}

// Tests Figure 7 on the wider actuator: at pi/2 the stiffness has grown by 1/(1 - (c alpha/V_ms)^2) and the
// natural frequency by its root (within what Coulomb friction at this amplitude shifts); gains for this angle
// bring back 150 rad/s and about 32 Hz.
TEST(Fig7, StiffnessGrowsWithTheAngle) {
  const model::Parameters p = ShippedModel("wide_actuator").parameters;
  const double displaced = p.c * kPi / 2 / p.V_ms;
  const double expected = 150 / std::sqrt(1 - displaced * displaced);
  const json& n = Fig7().numbers;
  EXPECT_NEAR(n.at("natural_frequency_rad_s").get<double>(), expected, 0.05 * expected);
  EXPECT_NEAR(n.at("expected").at("both_sides").at("natural_frequency_rad_s").get<double>(), expected, 0.1);
  EXPECT_GT(n.at("bandwidth_hz").get<double>(), 60);
  EXPECT_NEAR(Fig7().Case("mid_stroke").at("natural_frequency_rad_s").get<double>(), 150, 5);
  EXPECT_NEAR(Fig7().Case("redesigned").at("natural_frequency_rad_s").get<double>(), 150, 8);
  EXPECT_NEAR(Fig7().Case("redesigned").at("bandwidth_hz").get<double>(), 32, 5);
}

// Tests that with one side held the points are those of the analytic loop of the other side's volume.
TEST(Fig7, EitherSideMeetsTheAnalyticLoop) {
  const model::Parameters p = ShippedModel("wide_actuator").parameters;
  for (const auto& [key, volume] :
       {std::pair{"large_side", p.V_ms + p.c * kPi / 2}, std::pair{"small_side", p.V_ms - p.c * kPi / 2}}) {
    ExpectHandLoop(Fig7().Case(key), p, p.beta * p.D / volume, p.beta / volume * (p.c_E + p.c_I),
                   Gains(p, 0, 2));
  }
}

// Tests the waves' mode against the roots of the hand-made polynomial, found by Newton's method from 300 Hz.
TEST(Waves, ModeIsWhereThePaperMeasuredIt) {
  const json& n = Waves().numbers;
  const model::Parameters p = ShippedModel("table1").parameters;
  const auto q = design::WavePolynomial(p, 300, n.at("volume_fraction"), n.at("damping_assumed"), {0, 0});
  Complex s(0, 2 * kPi * 300);
  for (int i = 0; i < 50; ++i) {
    Complex value = 0;
    Complex slope = 0;
    for (int k = 4; k >= 0; --k) {
      slope = slope * s + value;
      value = value * s + q[k];
    }
    s -= value / slope;
  }
  EXPECT_NEAR(n.at("mode_frequency_hz").get<double>(), std::abs(s) / (2 * kPi), 1e-6);
  EXPECT_NEAR(n.at("mode_damping").get<double>(), -s.real() / std::abs(s), 1e-9);
  EXPECT_NEAR(n.at("mode_frequency_hz").get<double>(), 300, 3);  // "about 300 hz"
  EXPECT_NEAR(n.at("peak_hz").get<double>(), 300, 3);
  // A mode with damping d rises above the slope by 1/(2 d) within a band of 2 d 300 Hz.
  EXPECT_GT(n.at("peak_gain_db").get<double>(), -15);
  EXPECT_LT(n.at("linearised").at("worst_error_db"), 0.1);
  EXPECT_LT(n.at("linearised").at("worst_error_deg"), 1);
}

// Tests the gain that the waves allow against Routh's criterion: k_p with k_v unchanged, and omega_n at zeta
// = .5.
TEST(Waves, AllowedGainMeetsRouth) {
  const json& n = Waves().numbers;
  const model::Parameters p = ShippedModel("table1").parameters;
  const pressure_ctrl::PressureGains design = Gains(p, 0, 2);
  const double k_p = n.at("highest_stable_k_p_V_per_psi");
  const double omega = n.at("highest_stable_natural_frequency_rad_s");
  for (const double beside : {1 - 1e-5, 1 + 1e-5}) {
    EXPECT_EQ(design::RouthStable(design::WavePolynomial(
                  p, 300, n.at("volume_fraction"), n.at("damping_assumed"), {beside * k_p, design.k_v})),
              beside < 1);
    EXPECT_EQ(design::RouthStable(
                  design::WavePolynomial(p, 300, n.at("volume_fraction"), n.at("damping_assumed"),
                                         pressure_ctrl::DerivePressureGains(p, 0, beside * omega, 0.5, 2))),
              beside < 1);
  }
  EXPECT_GT(omega, 150);
  EXPECT_TRUE(n.at("sensors_at_pump").at("highest_stable_k_p_V_per_psi").is_null());
}

// Tests that the stack's waves decay below the sampled loop's limit and grow above it, at the rates of the
// poles.
TEST(Waves, StackConfirmsTheLimit) {
  const json& checks = Waves().numbers.at("time_check");
  ASSERT_EQ(checks.size(), 2u);
  for (const json& check : checks) {
    const double expected = check.at("expected_growth_per_s");
    EXPECT_EQ(expected > 0, check.at("part_of_limit").get<double>() > 1);
    EXPECT_NEAR(check.at("growth_per_s").get<double>(), expected, 0.1 * std::abs(expected));
  }
}

// Tests that the frequency follows the square root of 1/V_p + 1/(V_ms - V_p) as the line's volume changes, up
// to what the pump's inertia adds, and that less damping allows less gain.
TEST(Waves, VolumeAndDamping) {
  const json& rows = Waves().numbers.at("by_line_volume");
  ASSERT_GE(rows.size(), 5u);
  for (const json& row : rows) {
    const double x = row.at("volume_fraction");
    EXPECT_NEAR(row.at("mode_frequency_hz").get<double>(), 300 * std::sqrt(0.1 * 0.9 / (x * (1 - x))), 0.6)
        << x;
  }
  double last = 0;
  for (const json& row : Waves().numbers.at("by_damping")) {
    const double omega = row.at("highest_stable_natural_frequency_rad_s");
    EXPECT_GT(omega, last);
    last = omega;
  }
}

}  // namespace
}  // namespace hydro::experiments
