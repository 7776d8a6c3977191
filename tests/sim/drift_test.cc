// Hours of simulated time: what adds up over millions of ticks.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <hydro/state_t.hpp>
#include <vector>

#include "base/number_text.h"
#include "sim/simulation.h"
#include "tests/stack_fixture.h"

namespace hydro::sim {
namespace {

// 0.1 h in every run of the tests; HYDRO_SIMULATED_HOURS=10 on request (ctest -L on_request).
double Hours() {
  const char* const given = std::getenv("HYDRO_SIMULATED_HOURS");
  return given == nullptr ? 0.1 : ParseNumber(given).value();
}

// Tests that the last period of a periodic reference is as the second was, that each state has the time of
// its tick to the last digit, and that no tick is missing: nothing drifts.
TEST(DriftTest, TheLastPeriodIsAsTheSecond) {
  constexpr int64_t kRate = 1000, kPeriod = 4 * kRate;  // of 0.25 Hz
  settings::StackConfig config = testing::SmallStack();
  config.plant.rate_hz = kRate;
  config.position_interval_ticks = 5;
  config.reference.trajectory.kind = settings::TrajectorySpec::Kind::kSine;
  config.reference.trajectory.amplitude = 0.1;
  config.reference.trajectory.frequency_hz = 0.25;
  config.last_tick = std::llround(Hours() * 3600) * kRate / kPeriod * kPeriod;
  ASSERT_GE(config.last_tick, 10 * kPeriod);

  std::vector<state_t> second(kPeriod);
  int64_t ticks = 0;
  double angle = 0, pressure = 0;  // the largest differences
  const SimulationResult result = Simulate(config, [&](const bus::RawMessage& message) {
    if (message.channel != "HYDRO_STATE") return;
    state_t state;
    ASSERT_GT(state.decode(message.data, 0, message.size), 0);
    ASSERT_EQ(state.tick, ticks++);
    ASSERT_EQ(state.time, static_cast<double>(state.tick) / kRate);
    const auto place = static_cast<size_t>(state.tick % kPeriod);
    if (state.tick / kPeriod == 1) second[place] = state;
    if (state.tick < config.last_tick - kPeriod) return;
    angle = std::max(angle, std::fabs(state.arm_angle - second[place].arm_angle));
    pressure =
        std::max({pressure, std::fabs(state.p1 - second[place].p1), std::fabs(state.p2 - second[place].p2)});
  });
  EXPECT_EQ(result.exit_code, 0) << result.failure;
  EXPECT_EQ(ticks, config.last_tick + 1);
  // Friction lets the second period differ a little from those that follow it; drift over hours would be
  // larger by far.
  EXPECT_LT(angle, 1e-3) << "rad, of 0.1";
  EXPECT_LT(pressure, 5) << "psi";
}

}  // namespace
}  // namespace hydro::sim
