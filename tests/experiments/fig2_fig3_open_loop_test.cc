// Figures 2 and 3: the clamped actuator in open loop, against closed forms and a separate integration.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "experiments/figures/catalogue.h"
#include "experiments/studies/experiment.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

// Table 1.
constexpr double kD = 0.00796, kJ = 0.03, kB = 0.01455, kTs = 4, kBeta = 247000, kVms = 3.16, kCe = 6.5e-6,
                 kCi = 1e-6, kP3 = 100;
constexpr double kSpring = kBeta / kVms;  // psi/in^3 of one side

const ExperimentResult& Figure2Result() {
  static const ExperimentResult result = RunFig2({});
  return result;
}
const json& Fig2() {
  static const json numbers = ParseJson(Figure2Result().numbers);
  return numbers;
}
const json& Fig3() {
  static const json numbers = ParseJson(RunFig3({}).numbers);
  return numbers;
}

// Eqs. (4), (13), (14) by Runge-Kutta, switching at the ends of its steps of 10 us: times to some 10 us.
struct Cycles {
  std::vector<double> sticks;  // s
  double last_slip_dp = 0;
};
Cycles Integrate(double torque, double static_torque, bool valves, double duration) {
  constexpr double kStep = 1e-5;
  struct State {
    double w, p1, p2;
  } y{0, kP3, kP3};
  Cycles out;
  bool slips = false;
  const auto rate = [&](const State& at) {
    const double dp = at.p2 - at.p1;
    State d{slips ? (torque - kD * dp - kB * at.w - kTs) / kJ : 0,
            -kSpring * (kD * at.w - kCi * dp + kCe * (at.p1 - kP3)),
            -kSpring * (-kD * at.w + kCi * dp + kCe * (at.p2 - kP3))};
    if (valves && at.p1 <= kP3) d.p1 = std::max(0.0, d.p1);
    return d;
  };
  const auto moved = [](const State& a, const State& d, double h) {
    return State{a.w + h * d.w, a.p1 + h * d.p1, a.p2 + h * d.p2};
  };
  for (int i = 0; i * kStep < duration; ++i) {
    const double net = torque - kD * (y.p2 - y.p1);
    if (!slips && net > static_torque) {
      slips = true;
      out.last_slip_dp = y.p2 - y.p1;
    }
    const State a = rate(y), b = rate(moved(y, a, kStep / 2)), c = rate(moved(y, b, kStep / 2)),
                d = rate(moved(y, c, kStep));
    y = moved(
        y,
        {a.w + 2 * b.w + 2 * c.w + d.w, a.p1 + 2 * b.p1 + 2 * c.p1 + d.p1, a.p2 + 2 * b.p2 + 2 * c.p2 + d.p2},
        kStep / 6);
    if (valves) y.p1 = std::max(y.p1, kP3);
    if (slips && y.w <= 0) {
      y.w = 0;
      slips = false;
      out.sticks.push_back(i * kStep);
    }
  }
  return out;
}

const json& AtRest(double torque, double static_torque) {
  for (const json& row : Fig2()["at_rest_only"]["scan"]) {
    if (row["torque_in_lbf"] == torque && row["static_torque_in_lbf"] == static_torque) return row;
  }
  throw std::out_of_range("no such row");
}

// Tests that Table 1 alone sticks exactly once and then creeps, at every low torque, with and without the
// valves, as the separate integration does.
TEST(Figure2, Table1SticksOnce) {
  const json& table1 = Fig2()["table1"];
  EXPECT_EQ(table1["sticks"], 1);
  EXPECT_EQ(table1["by_torque"].size(), 6u);
  for (const json& row : table1["by_torque"]) {
    EXPECT_EQ(row["sticks"], 1) << row;
    EXPECT_FALSE(row["sustained"]) << row;
  }
  EXPECT_GT(table1["final_motor_speed_rad_s"], 0);
  for (const bool valves : {true, false}) {
    const Cycles own = Integrate(6, 4, valves, 8);
    ASSERT_EQ(own.sticks.size(), 1u);
    if (valves) {
      EXPECT_NEAR(table1["stick_time_s"].get<double>(), own.sticks[0], 5e-5);
    }
  }
  // Steady creep: D theta' = (c_E + c_I) dp, T_p = D dp + b theta' + T_s.
  const double creep = (kCe + kCi) / kD;
  EXPECT_NEAR(table1["final_dp_psi"].get<double>(), 2 / (kD + kB * creep), 0.01);
  EXPECT_NEAR(table1["slip_dp_psi"].get<double>(), 2 / kD, 1e-3);
}

// Tests that static friction above kinetic gives sustained cycles, with the period and swing of the shipped
// model.
TEST(Figure2, StribeckCycles) {
  const json& stribeck = Fig2()["stribeck"];
  EXPECT_GE(stribeck["sticks"], 12);
  EXPECT_NEAR(stribeck["period_s"].get<double>(), 1.474, 0.005);
  EXPECT_NEAR(stribeck["high_psi"].get<double>(), 329.5, 0.5);
  EXPECT_NEAR(stribeck["low_psi"].get<double>(), 147.1, 0.5);
  EXPECT_DOUBLE_EQ(stribeck["swing_psi"].get<double>(),
                   stribeck["high_psi"].get<double>() - stribeck["low_psi"].get<double>());
  EXPECT_NEAR(stribeck["slip_dp_psi"].get<double>(), 1.2 / kD, 1e-3);
  // A stick lasts until leakage has lowered dp to where static friction no longer holds the pump.
  EXPECT_NEAR(stribeck["stick_duration_s"].get<double>(),
              std::log(stribeck["stick_dp_psi"].get<double>() / (1.2 / kD)) / (kSpring * (2 * kCi + kCe)),
              1e-5);
}

// Tests where cycles begin at T_p = 6, and that the bound scales with (T_p - T_s): an excess that cycles at
// T_p = 6 does not at T_p = 10.
TEST(Figure2, ThresholdOfStaticFriction) {
  EXPECT_FALSE(AtRest(6, 4.2)["sustained"]);
  EXPECT_TRUE(AtRest(6, 4.22)["sustained"]);
  EXPECT_TRUE(AtRest(6, 4.4)["sustained"]);
  EXPECT_FALSE(AtRest(10, 4.4)["sustained"]);
  const double ratio = Fig2()["at_rest_only"]["threshold_excess_ratio"];
  EXPECT_GT(ratio, 0.1);
  EXPECT_LT(ratio, 0.11);
  EXPECT_EQ(Integrate(6, 4.2, true, 10).sticks.size(), 1u);
  EXPECT_GT(Integrate(6, 4.22, true, 10).sticks.size(), 10u);
}

// Tests periods and swings over the excess ratio .11, .2, .4, .8, against known values and a separate
// integration with friction that is static at rest only. dp overshoots a little where the pump sticks and
// slips.
TEST(Figure2, PeriodsAndSwings) {
  struct Row {
    double static_torque, period, stick_dp, slip_dp;
  };
  for (const Row& row : {Row{4.22, 0.59, 268.0, 223.6}, Row{4.4, 0.81, 286, 201}, Row{4.8, 1.42, 325, 151},
                         Row{5.6, 3.42, 412.1, 50.3}}) {
    const json& here = AtRest(6, row.static_torque);
    EXPECT_NEAR(here["period_s"].get<double>(), row.period, 0.005) << here;
    EXPECT_NEAR(here["stick_dp_psi"].get<double>(), row.stick_dp, 0.6) << here;
    EXPECT_NEAR(here["slip_dp_psi"].get<double>(), row.slip_dp, 0.6) << here;
    EXPECT_GT(here["high_psi"].get<double>(), here["stick_dp_psi"].get<double>());
    EXPECT_LT(here["low_psi"].get<double>(), here["slip_dp_psi"].get<double>());
    const Cycles own = Integrate(6, row.static_torque, true, 16);
    ASSERT_GE(own.sticks.size(), 4u);
    const size_t last = own.sticks.size() - 1;
    EXPECT_NEAR(here["period_s"].get<double>(), own.sticks[last] - own.sticks[last - 1], 1e-3) << here;
    EXPECT_NEAR(here["slip_dp_psi"].get<double>(), own.last_slip_dp, 0.01) << here;
  }
}

// Tests that the paper's contradiction is reported with its figures.
TEST(Figure2, Finding) {
  const ExperimentResult& result = Figure2Result();
  ASSERT_EQ(result.findings.size(), 1u);
  EXPECT_EQ(result.findings[0].number, 3);
  EXPECT_NE(result.findings[0].evidence.find("4.203 cycles"), std::string::npos)
      << result.findings[0].evidence;
  for (const tables::Column& column : result.table.columns) {
    EXPECT_EQ(column.values.size(), result.table.rows()) << column.name;
  }
}

// A second-order step response, J theta'' = 6 - D dp - b theta', dp' = stiffness D theta' - leak dp: time and
// height of the first peak.
struct Peak {
  double time, dp;
};
Peak SecondOrderPeak(double stiffness, double leak) {
  const double decay = (kB / kJ + leak) / 2;
  const double square = (stiffness * kD * kD + kB * leak) / kJ;
  const double time = std::numbers::pi / std::sqrt(square - decay * decay);
  const double final_dp = 6 * stiffness * kD / (kJ * square);
  return {time, final_dp * (1 + std::exp(-decay * time))};
}

// Tests that the 10 in-lbf step peaks, sticks and slips at the known times, and at the times of the closed
// form of one side of fluid on the pump's inertia.
TEST(Figure3, PeakStickAndSlip) {
  const json& fig3 = Fig3();
  EXPECT_NEAR(fig3["peak_p2_psi"].get<double>(), 1512.6, 0.05);
  EXPECT_NEAR(fig3["peak_dp_psi"].get<double>(), 1412.6, 0.05);
  EXPECT_NEAR(fig3["peak_time_s"].get<double>(), 0.2445, 5e-5);
  EXPECT_NEAR(fig3["stick_time_s"].get<double>(), 0.252, 5e-4);
  EXPECT_NEAR(fig3["slip_time_s"].get<double>(), 1.194, 5e-4);
  EXPECT_NEAR(fig3["slip_dp_psi"].get<double>(), 753.8, 0.05);

  const Peak peak = SecondOrderPeak(kSpring, kSpring * (kCi + kCe));
  EXPECT_NEAR(fig3["peak_time_s"].get<double>(), peak.time, 2e-6);
  EXPECT_NEAR(fig3["peak_dp_psi"].get<double>(), peak.dp, 1e-4);
  EXPECT_NEAR(fig3["natural_frequency_rad_s"].get<double>(), kD * std::sqrt(kSpring / kJ), 1e-9);
  EXPECT_NEAR(fig3["natural_frequency_rad_s"].get<double>(), 12.85, 0.005);
  EXPECT_NEAR(fig3["damping_ratio"].get<double>(), 0.042, 5e-4);
  EXPECT_NEAR(fig3["slip_dp_psi"].get<double>(), 6 / kD, 1e-3);
  EXPECT_NEAR(fig3["slip_time_s"].get<double>() - fig3["stick_time_s"].get<double>(),
              std::log(fig3["stick_dp_psi"].get<double>() / (6 / kD)) / (kSpring * (2 * kCi + kCe)), 3e-6);
  const Cycles own = Integrate(10, 4, true, 1.5);
  ASSERT_EQ(own.sticks.size(), 1u);
  EXPECT_NEAR(fig3["stick_time_s"].get<double>(), own.sticks[0], 5e-5);
  EXPECT_EQ(fig3["sticks"], 1);
}

// Tests that without the valves both sides are the spring: dp peaks nearly as high, in closed form, but p_1
// would be far below 0.
TEST(Figure3, WithoutValves) {
  const json& bare = Fig3()["without_valves"];
  const Peak peak = SecondOrderPeak(2 * kSpring, kSpring * (2 * kCi + kCe));
  EXPECT_NEAR(bare["peak_dp_psi"].get<double>(), peak.dp, 1e-3);
  EXPECT_NEAR(bare["peak_time_s"].get<double>(), peak.time, 1e-4);
  EXPECT_NEAR(bare["peak_dp_psi"].get<double>(), 1434.8, 0.05);
  EXPECT_NEAR(bare["p2_psi"].get<double>(), 817, 0.5);
  EXPECT_NEAR(bare["p1_psi"].get<double>(), -617, 0.5);
  EXPECT_NEAR(bare["p1_negative_from_s"].get<double>(), 0.0415, 5e-4);
}

}  // namespace
}  // namespace hydro::experiments
