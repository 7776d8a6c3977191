// Hours of simulated time: what adds up over millions of ticks.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <hydro/state_t.hpp>

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

// The root mean squares of what is measured, over one period.
struct PeriodSums {
  double angle = 0, p1 = 0, p2 = 0;

  void Add(const state_t& state) {
    angle += state.arm_angle * state.arm_angle;
    p1 += state.p1 * state.p1;
    p2 += state.p2 * state.p2;
  }
};

// Tests that the last period of a periodic reference is as the second was, that each state has the time of
// its tick to the last digit, and that no tick is missing: nothing drifts.
TEST(DriftTest, TheLastPeriodIsAsTheSecond) {
  constexpr int64_t kRate = 1000, kPeriod = 4 * kRate;  // of 0.25 Hz
  settings::StackConfig config = testing::SmallStack();
  config.plant.rate_hz = kRate;
  config.position_interval_ticks = 5;
  config.position.c1 = 6000;  // the gains of config/demo.toml: stable wherever the sides compress
  config.position.c2 = 1200;
  config.reference.trajectory.kind = settings::TrajectorySpec::Kind::kSine;
  config.reference.trajectory.amplitude = 0.1;
  config.reference.trajectory.frequency_hz = 0.25;
  config.last_tick = std::llround(Hours() * 3600) * kRate / kPeriod * kPeriod;
  ASSERT_GE(config.last_tick, 10 * kPeriod);

  PeriodSums second, last;
  int64_t ticks = 0;
  const SimulationResult result = Simulate(config, [&](const bus::RawMessage& message) {
    if (message.channel != "HYDRO_STATE") return;
    state_t state;
    ASSERT_GT(state.decode(message.data, 0, message.size), 0);
    ASSERT_EQ(state.tick, ticks++);
    ASSERT_EQ(state.time, static_cast<double>(state.tick) / kRate);
    if (state.tick / kPeriod == 1) second.Add(state);
    if (state.tick / kPeriod == config.last_tick / kPeriod - 1) last.Add(state);
  });
  EXPECT_EQ(result.exit_code, 0) << result.failure;
  EXPECT_EQ(ticks, config.last_tick + 1);
  EXPECT_GT(std::sqrt(second.angle / kPeriod), 0.03) << "the arm moves";
  // Where the pump sticks and slips, no two periods are alike to the last digit.
  EXPECT_NEAR(last.angle / second.angle, 1, 0.02);
  EXPECT_NEAR(last.p1 / second.p1, 1, 0.05);
  EXPECT_NEAR(last.p2 / second.p2, 1, 0.05);
}

}  // namespace
}  // namespace hydro::sim
