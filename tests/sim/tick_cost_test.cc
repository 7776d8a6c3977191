// What a tick of the whole stack in one process costs, as far as it can be counted.
#include <gtest/gtest.h>

#include <cstdint>
#include <hydro/state_t.hpp>

#include "bus/in_process_bus.h"
#include "plant/plant_app.h"
#include "plant/simulated_rig.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "sim/simulation.h"
#include "tests/bus/count_allocations.h"
#include "tests/stack_fixture.h"

namespace hydro::sim {
namespace {

settings::StackConfig Seconds(int seconds) {
  settings::StackConfig config = testing::SmallStack();
  config.noise.p1_psi = 1;
  config.time.duration_s = seconds;
  config.last_tick = seconds * 1000;
  return config;
}

int64_t AllocationsOf(const settings::StackConfig& config) {
  const int64_t before = bus::AllocationCount();
  EXPECT_EQ(Simulate(config, nullptr).exit_code, 0);
  return bus::AllocationCount() - before;
}

// Tests that a simulated second takes no memory, its reports included: a run of four takes what one of two
// does.
TEST(TickCostTest, TakesNoMemory) {
  AllocationsOf(Seconds(1));  // what is made once a process
  const int64_t two = AllocationsOf(Seconds(2));
  EXPECT_GT(two, 0);
  EXPECT_EQ(AllocationsOf(Seconds(4)), two);
}

// The machine's clocks, counting how often they are read.
class CountingClock : public bus::WallClock {
 public:
  int64_t Utime() const override { return Counted(WallClock::Utime()); }
  Duration Suspended() const override {
    ++readings;  // two clocks
    return Counted(WallClock::Suspended());
  }
  Duration SuspendedAtMost(TimePoint now) const override { return Counted(WallClock::SuspendedAtMost(now)); }

  mutable int64_t readings = 0;

 private:
  TimePoint Read() const override { return Counted(std::chrono::steady_clock::now()); }
  template <class Value>
  Value Counted(Value value) const {
    ++readings;
    return value;
  }
};

// Tests that a tick in real time of all three applications in one process reads a clock thirteen times at
// most, what comes once a second aside: a limb has tens of them.
TEST(TickCostTest, ReadsTheClockSeldom) {
  settings::StackConfig config = testing::SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  config.limits.stale_input_s = 10;  // no faults on a machine that stands still
  config.last_tick = 300;
  CountingClock clock;
  bus::InProcessBus bus(nullptr);
  plant::SimulatedRig rig(config);
  plant::PlantApp plant(bus, clock, config, rig);
  pressure_ctrl::PressureApp pressure(bus, clock, config);
  position_ctrl::PositionApp position(bus, clock, config);
  int64_t states = 0;
  bus.Subscribe<state_t>("HYDRO_STATE", [&](const state_t&) { ++states; });
  EXPECT_EQ(plant.Run(), 0) << plant.failure();
  EXPECT_GT(states, 0);
  EXPECT_GT(clock.readings, 5 * states);
  EXPECT_LE(clock.readings, 13 * states + 100);
}

}  // namespace
}  // namespace hydro::sim
