// Stick and slip of the clamped plant under constant torque: Table 1 alone, and with static friction above
// kinetic.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

struct StickSlip {
  std::vector<double> stick_times;
  std::vector<double> slip_times;
  double stick_dp = 0;    // when it last stuck
  double slip_dp = 0;     // when it last slipped again
  double largest_dp = 0;  // over the second half
  double smallest_dp = 1e9;
  double last_dp = 0;
  double last_speed = 0;
};

// Constant torque from rest at p_3. Event times to 0.1 ms.
StickSlip Observe(const model::ModelDescription& model, double torque, double duration) {
  Rig rig(model, Held(model::Shaft::kClamped));
  StickSlip seen;
  bool stuck = true;
  const int ticks = static_cast<int>(std::lround(duration * 1e4));
  for (int i = 1; i <= ticks; ++i) {
    rig.simulation->Advance(torque / 4.0, i * 1e-4);
    const bool sticks = rig.simulation->mode().pump == 0;
    const model::Measurement m = rig.Measure();
    seen.last_dp = m.p2 - m.p1;
    if (sticks && !stuck) {
      seen.stick_times.push_back(i * 1e-4);
      seen.stick_dp = seen.last_dp;
    }
    if (!sticks && stuck && i > 1) {
      seen.slip_times.push_back(i * 1e-4);
      seen.slip_dp = seen.last_dp;
    }
    stuck = sticks;
    seen.last_speed = m.motor_speed;
    if (i > ticks / 2) {
      seen.largest_dp = std::max(seen.largest_dp, seen.last_dp);
      seen.smallest_dp = std::min(seen.smallest_dp, seen.last_dp);
    }
  }
  return seen;
}

// Static friction exceeds kinetic friction at rest only: the excess is gone at 0.01 rad/s, where the pump has
// hardly moved.
model::ModelDescription WithStatic(double static_torque) {
  return Table1Model({Stribeck(static_torque / 4.0 - 1, 1e-4)});
}

// Tests that the paper's equations stick exactly once and then creep, for torques from 4.1 to 10 in-lbf.
TEST(Table1, SticksExactlyOnce) {
  for (const double torque : {4.1, 4.5, 6.0, 8.0, 10.0}) {
    const StickSlip seen = Observe(Table1Model(), torque, 10);
    EXPECT_EQ(seen.stick_times.size(), 1u) << torque;
    EXPECT_EQ(seen.slip_times.size(), 1u) << torque;
    EXPECT_GT(seen.last_speed, 0) << torque;
  }
}

// Tests that the pump slips again exactly where friction no longer holds the net torque, at dp = (T_p -
// T_s)/D.
TEST(Table1, SlipsAgainAtTheBalance) {
  for (const auto& [torque, balance] : {std::pair{4.5, 62.8}, {6.0, 251.3}, {10.0, 753.8}}) {
    Rig rig(Table1Model(), Held(model::Shaft::kClamped));
    bool was_stuck = false;
    double dp = 0;
    for (int i = 1; i <= 50000; ++i) {
      rig.simulation->Advance(torque / 4.0, i * 1e-4);
      const bool sticks = rig.simulation->mode().pump == 0;
      dp = rig.Measure().p2 - rig.Measure().p1;
      if (was_stuck && !sticks) break;
      was_stuck = sticks;
    }
    EXPECT_TRUE(was_stuck);
    EXPECT_NEAR(dp, balance, 0.1);
    EXPECT_NEAR(dp, (torque - 4.0) / 0.00796, 0.1);
  }
}

// Tests that a torque below friction never moves anything.
TEST(Table1, HoldsBelowFriction) {
  model::Actuator actuator(Table1Model(), Held(model::Shaft::kFree));
  actuator.Advance(3.999 / 4.0, 100);
  EXPECT_EQ(actuator.Measure().motor_angle, 0);
  EXPECT_EQ(actuator.Measure().p1, 100);
  EXPECT_EQ(actuator.Measure().p2, 100);
}

// Tests where sustained stick-slip begins at T_p = 6: static friction of 4.20 in-lbf still creeps, 4.22
// cycles.
TEST(Stribeck, CyclesOnlyAboveAnExcess) {
  const StickSlip creeps = Observe(WithStatic(4.20), 6, 30);
  EXPECT_LT(creeps.largest_dp - creeps.smallest_dp, 1);
  const StickSlip cycles = Observe(WithStatic(4.22), 6, 30);
  EXPECT_GT(cycles.largest_dp - cycles.smallest_dp, 20);
  EXPECT_GT(cycles.stick_times.size(), 20u);
}

// Tests the cycles' period and the pressure differences between which the pump sticks, at T_p = 6, against an
// independent integration. dp goes a little higher before the pump sticks and a little lower after it slips.
TEST(Stribeck, PeriodAndSwing) {
  struct Row {
    double static_torque, period, stick_dp, slip_dp;
  };
  for (const Row& row : {Row{4.4, 0.81, 286, 201}, Row{4.8, 1.42, 325, 151}}) {
    const StickSlip seen = Observe(WithStatic(row.static_torque), 6, 20);
    ASSERT_GT(seen.stick_times.size(), 4u);
    const size_t last = seen.stick_times.size() - 1;
    EXPECT_NEAR((seen.stick_times[last] - seen.stick_times[last - 3]) / 3, row.period, 0.005)
        << row.static_torque;
    EXPECT_NEAR(seen.stick_dp, row.stick_dp, 0.6) << row.static_torque;
    EXPECT_NEAR(seen.slip_dp, row.slip_dp, 0.6) << row.static_torque;
    EXPECT_NEAR(seen.slip_dp, (6 - row.static_torque) / 0.00796, 0.1) << row.static_torque;
    EXPECT_GT(seen.largest_dp, seen.stick_dp);
    EXPECT_LT(seen.smallest_dp, seen.slip_dp);
  }
}

// Tests that the pump breaks away from rest at T_s (1 + static_excess), not at T_s.
TEST(Stribeck, BreaksAwayAtStaticFriction) {
  model::Actuator actuator(Table1Model({Stribeck(0.5, 3)}), Held(model::Shaft::kClamped));
  actuator.Advance(5.999 / 4.0, 1);
  EXPECT_EQ(actuator.Measure().motor_speed, 0);
  actuator.Advance(6.001 / 4.0, 1.1);
  EXPECT_GT(actuator.Measure().motor_speed, 0);
}

}  // namespace
}  // namespace hydro::testing
