#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests the steady speed of the bypassed pump at full voltage, T_pmax (1 - w/w_0) = T_s + b w, and that
// braking is not limited.
TEST(SpeedTorqueLimit, LimitsDrivingOnly) {
  const double w_0 = 1000;
  for (const double sign : {1.0, -1.0}) {
    for (const model::Integrator integrator : kIntegrators) {
      model::ActuatorOptions options = Bypassed();
      options.integrator = integrator;
      Rig rig(Table1Model({{"motor.speed_torque_limit", {{"no_load_speed", w_0}}, {}}}), options);
      rig.simulation->Advance(sign * 10, 20);
      EXPECT_NEAR(rig.Measure().motor_speed, sign * (40 - 4) / (0.01455 + 40 / w_0), 1e-4);
      EXPECT_NEAR(TermsOf(rig, sign * 10).torque, sign * 40 * (1 - 36 / (0.01455 * w_0 + 40)), 1e-5);
      rig.simulation->Advance(sign * 2, 20.1);  // 8 in-lbf are below the limit
      EXPECT_EQ(TermsOf(rig, sign * 2).torque, sign * 8);
      rig.simulation->Advance(-sign * 10, 20.2);
      ASSERT_GT(sign * rig.Measure().motor_speed, 100);
      EXPECT_EQ(TermsOf(rig, -sign * 10).torque, -sign * 40);
    }
  }
}

// Tests that above no_load_speed there is no driving torque, and that a torque requested through a lag meets
// the limit on its way up and leaves it on its way down.
TEST(SpeedTorqueLimit, BeyondNoLoadSpeedAndBehindALag) {
  Rig rig(Table1Model({{"motor.speed_torque_limit", {{"no_load_speed", 200}}, {}}, Lag(0.05)}), Bypassed());
  std::set<int> positions;
  double least_room = 1e9;
  for (int tick = 0; tick < 4000; ++tick) {
    const double voltage = tick < 1500 ? 10 : tick < 3000 ? 2 : -10;
    rig.simulation->Advance(voltage, (tick + 1) * 1e-3);
    const model::Terms<double> x = TermsOf(rig, voltage);
    positions.insert(rig.simulation->mode().effects[1]);
    const double lagged = std::clamp(rig.simulation->now().state[4], -40.0, 40.0);
    const double room = 40 * (1 - std::abs(x.motor_speed) / 200);
    const bool drives = lagged * x.motor_speed > 0;
    const double expected =
        drives ? std::copysign(std::min(std::abs(lagged), std::max(0.0, room)), lagged) : lagged;
    ASSERT_NEAR(x.torque, expected, 1e-6) << tick;
    least_room = std::min(least_room, room);
  }
  EXPECT_TRUE(positions.contains(0) && positions.contains(1) && positions.contains(-1));

  const model::Equations& equations = rig.equations;
  double state[5] = {0, 300, 100, 100, 20};
  double margin[model::kMaxSwitches];
  double rate[model::kMaxStates];
  model::Mode mode;
  mode.pump = 1;
  equations.Rates(0, 5, mode, state, rate, margin);
  ASSERT_LT(margin[4], 0);
  equations.Cross(4, 0, 5, state, &mode);
  EXPECT_EQ(mode.effects[1], 2);
  equations.Rates(0, 5, mode, state, rate, margin);
  EXPECT_GT(margin[4], 0);
  EXPECT_DOUBLE_EQ(rate[model::kMotorSpeed], -(4 + 0.01455 * 300) / 0.03);

  // Back: to the line when the pump has slowed down, to no limit when the requested torque opposes the speed.
  const model::Mode beyond = mode;
  state[model::kMotorSpeed] = 199;
  equations.Rates(0, 5, mode, state, rate, margin);
  ASSERT_LT(margin[4], 0);
  equations.Cross(4, 0, 5, state, &mode);
  EXPECT_EQ(mode.effects[1], 1);
  mode = beyond;
  state[model::kMotorSpeed] = 300;
  state[4] = -5;
  equations.Rates(0, 5, mode, state, rate, margin);
  ASSERT_LT(margin[4], 0);
  equations.Cross(4, 0, 5, state, &mode);
  EXPECT_EQ(mode.effects[1], 0);
}

}  // namespace
}  // namespace hydro::testing
