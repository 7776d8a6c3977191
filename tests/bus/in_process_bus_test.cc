#include "bus/in_process_bus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hydro/motor_command_t.hpp"
#include "hydro/state_t.hpp"
#include "tests/bus/count_allocations.h"

namespace hydro::bus {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

// Tests that messages of all channels are handled in the order in which they were published.
TEST(InProcessBusTest, KeepsOrderAcrossChannels) {
  SimulatedClock clock;
  InProcessBus bus(&clock);
  std::vector<std::string> seen;
  bus.Subscribe<state_t>("A", [&](const state_t&) { seen.push_back("A"); });
  bus.Subscribe<state_t>("B", [&](const state_t&) { seen.push_back("B"); });
  for (const char* channel : {"A", "B", "B", "A", "B"}) bus.Publish(channel, state_t{});
  EXPECT_EQ(bus.HandleUntil(clock.Now() + 1s), 5);
  EXPECT_THAT(seen, ElementsAre("A", "B", "B", "A", "B"));
}

// Tests that one call handles the messages that were waiting when it began, and that time stands still
// meanwhile.
TEST(InProcessBusTest, OneTurnAtATime) {
  SimulatedClock clock;
  InProcessBus bus(&clock);
  int handled = 0;
  bus.Subscribe<state_t>("A", [&](const state_t& state) {
    ++handled;
    bus.Publish("A", state);
    bus.Publish("A", state);
  });
  bus.Publish("A", state_t{});
  const auto deadline = clock.Now() + 1s;
  EXPECT_EQ(bus.HandleUntil(deadline), 1);
  EXPECT_EQ(bus.HandleUntil(deadline), 2);
  EXPECT_EQ(bus.HandleUntil(deadline), 4);
  EXPECT_EQ(handled, 7);
  EXPECT_EQ(clock.Now(), Clock::TimePoint());
}

// Tests that a tap sees a message before its typed handlers do, at dispatch and at the simulated time.
TEST(InProcessBusTest, TapComesFirst) {
  SimulatedClock clock;
  InProcessBus bus(&clock);
  std::vector<std::string> seen;
  bus.Subscribe<state_t>("A", [&](const state_t&) { seen.push_back("typed"); });
  bus.SubscribeAll(
      [&](const RawMessage& message) { seen.push_back("tap at " + std::to_string(message.receive_utime)); });
  bus.Publish("A", state_t{});
  clock.AdvanceTo(clock.Now() + 7us);
  bus.HandleUntil(clock.Now());
  EXPECT_THAT(seen, ElementsAre("tap at 7", "typed"));
}

// Tests that, as on a network, a message without subscribers is not kept for a later one.
TEST(InProcessBusTest, KeepsNothingForNobody) {
  SimulatedClock clock;
  InProcessBus bus(&clock);
  bus.Publish("A", state_t{});
  int seen = 0;
  bus.Subscribe<state_t>("A", [&](const state_t&) { ++seen; });
  EXPECT_EQ(bus.HandleUntil(clock.Now() + 1s), 0);
  EXPECT_EQ(seen, 0);
}

// Tests that a message stays intact while its handler publishes so much on the same channel that the queue
// grows.
TEST(InProcessBusTest, MessageInHandStays) {
  SimulatedClock clock;
  InProcessBus bus(&clock);
  bool published = false;
  int64_t sum = 0;
  bus.Subscribe<state_t>("A", [&](const state_t& state) {
    if (!std::exchange(published, true)) {
      for (int i = 0; i < 1000; ++i) {
        state_t next{};
        next.tick = 1;
        bus.Publish("A", next);
      }
      EXPECT_EQ(state.tick, 42);
    } else {
      sum += state.tick;
    }
  });
  state_t first{};
  first.tick = 42;
  bus.Publish("A", first);
  EXPECT_EQ(bus.HandleUntil(clock.Now()), 1);
  EXPECT_EQ(bus.HandleUntil(clock.Now()), 1000);
  EXPECT_EQ(sum, 1000);
}

// Tests that exchanging states and commands allocates nothing once it is running.
TEST(InProcessBusTest, AllocatesNothingInTheSteadyState) {
  SimulatedClock clock;
  InProcessBus bus(&clock);
  const std::string state_channel = "HYDRO_STATE", command_channel = "HYDRO_MOTOR_COMMAND";
  Publisher<state_t> states = bus.Advertise<state_t>(state_channel);
  int64_t commands = 0;
  bus.Subscribe<state_t>(state_channel,
                         [&](const state_t&) { bus.Publish(command_channel, motor_command_t{}); });
  bus.Subscribe<motor_command_t>(command_channel, [&](const motor_command_t&) { ++commands; });
  const auto exchange = [&](int count) {
    for (int i = 0; i < count; ++i) {
      states.Send(state_t{});
      bus.HandleUntil(clock.Now());
      bus.HandleUntil(clock.Now());
    }
  };
  exchange(100);
  const int64_t before = AllocationCount();
  exchange(10'000);
  EXPECT_EQ(AllocationCount() - before, 0);
  EXPECT_EQ(commands, 10'100);
}

}  // namespace
}  // namespace hydro::bus
