// The shipped stack with a cylinder whose rod is on one side.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <hydro/state_t.hpp>
#include <string>
#include <vector>

#include "settings/stack_config.h"
#include "sim/simulation.h"
#include "tune/design/loop_check.h"

namespace hydro::sim {
namespace {

const std::string kConfig = std::string(HYDRO_SOURCE_DIR) + "/config/differential_cylinder.toml";

// Tests that the cylinder goes out, in and out again under its load to within half a millimetre, without
// running into a limit, that its loops are said to be stable with the margins that hydro-tune keeps, and that
// it does not hammer where the arm slips: gains that only the friction of the seals stops from swinging
// change the sign of the voltage tens of times in a step.
TEST(DifferentialCylinder, ReachesItsTargets) {
  const settings::StackConfig config = settings::LoadStackConfig(kConfig);
  const design::LoopCheck check = design::CheckLoops(config);
  ASSERT_TRUE(check.stable() && check.position);
  for (const design::CheckedLoop& loop : {*check.pressure, *check.position}) {
    EXPECT_GE(loop.worst.gain, 2) << design::Describe(check);
    EXPECT_GE(loop.worst.phase_deg, 30) << design::Describe(check);
  }
  std::vector<state_t> states;
  const int exit_code = Simulate(config, [&](const bus::RawMessage& message) {
                          if (!std::string(message.channel).starts_with("HYDRO_STATE")) return;
                          state_t state;
                          ASSERT_GT(state.decode(message.data, 0, static_cast<int>(message.size)), 0);
                          states.push_back(state);
                        }).exit_code;
  EXPECT_EQ(exit_code, 0);
  ASSERT_EQ(states.size(), 8001u);
  const auto at = [&](double seconds) { return states[static_cast<size_t>(2000 * seconds)]; };
  EXPECT_NEAR(at(1.45).arm_angle, 0.015, 5e-4);
  EXPECT_NEAR(at(2.75).arm_angle, -0.010, 5e-4);
  EXPECT_NEAR(at(4.0).arm_angle, 0.005, 5e-4);
  int reversals = 0;
  for (size_t i = 1; i < states.size(); ++i) reversals += states[i].voltage * states[i - 1].voltage < 0;
  EXPECT_LT(reversals, 20) << "in three steps";
  // It rests, and does not swing between the modes of its valves.
  EXPECT_NEAR(at(3.9).voltage, at(4.0).voltage, 0.1);
  EXPECT_LT(std::abs(at(4.0).arm_speed), 1e-3);
  // At rest under its load, the forces balance by the two areas.
  EXPECT_NEAR(1.9635e-3 * at(4.0).p2 - 1.3477e-3 * at(4.0).p1, 4000, 200);
  double highest = 0;
  for (const state_t& state : states) highest = std::max({highest, state.p1, state.p2});
  EXPECT_LT(highest, 210e5);
}

}  // namespace
}  // namespace hydro::sim
