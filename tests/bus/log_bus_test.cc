#include "bus/log_bus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hydro/motor_command_t.hpp"
#include "hydro/state_t.hpp"

namespace hydro::bus {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

constexpr int64_t kStart = 1'700'000'000'000'000;  // us

struct Event {
  std::string channel;
  std::vector<uint8_t> bytes;
  int64_t utime;
};

Event StateEvent(int64_t tick, const std::string& channel = "STATE") {
  state_t state{};
  state.tick = tick;
  std::vector<uint8_t> bytes(state.getEncodedSize());
  state.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return {channel, bytes, kStart + 1000 * tick};
}

LogBus::EventSource Source(const std::vector<Event>& events) {
  return [&events, next = size_t{0}](RawMessage* message) mutable {
    if (next == events.size()) return false;
    const Event& event = events[next++];
    *message = {event.channel, event.bytes.data(), static_cast<int>(event.bytes.size()), event.utime};
    return true;
  };
}

// Tests that a handler that subscribes to its own channel, and a tap that subscribes, add who gets the next
// event, and not this one: as every transport does (bus_contract_test.cc).
TEST(LogBusTest, HandlersMaySubscribeToTheirOwnChannel) {
  const std::vector<Event> events = {StateEvent(0), StateEvent(1)};
  SimulatedClock clock;
  LogBus bus(Source(events), {.clock = &clock});
  std::vector<std::string> heard;
  bool tapped = false;
  bus.SubscribeAll([&](const RawMessage&) {
    if (std::exchange(tapped, true)) return;
    bus.SubscribeAll([&](const RawMessage&) { heard.emplace_back("tap"); });
    bus.Subscribe<state_t>("STATE", [&](const state_t&) { heard.emplace_back("by the tap"); });
  });
  bus.Subscribe<state_t>("STATE", [&](const state_t& state) {
    heard.emplace_back("first");
    if (state.tick == 0)
      bus.Subscribe<state_t>("STATE", [&](const state_t&) { heard.emplace_back("second"); });
  });
  bus.HandleUntil(clock.Now());
  EXPECT_THAT(heard, ElementsAre("first"));
  heard.clear();
  bus.HandleUntil(clock.Now() + 1ms);
  EXPECT_THAT(heard, ElementsAre("tap", "first", "by the tap", "second"));
}

// Tests that events come one at a time, in file order and at their own times, and that the end is announced.
TEST(LogBusTest, FeedsEventsAtTheirTimes) {
  const std::vector<Event> events = {StateEvent(0), StateEvent(1), StateEvent(5)};
  SimulatedClock clock;
  LogBus bus(Source(events), {.clock = &clock});
  EXPECT_EQ(clock.Utime(), kStart);
  std::vector<int64_t> times;
  bus.Subscribe<state_t>("STATE", [&](const state_t& state) {
    EXPECT_EQ(clock.Utime(), kStart + 1000 * state.tick);
    times.push_back(state.tick);
  });
  EXPECT_EQ(bus.HandleUntil(clock.Now()), 1);
  EXPECT_EQ(bus.HandleUntil(clock.Now() + 1ms), 1);
  EXPECT_EQ(bus.HandleUntil(clock.Now() + 3ms), 0);  // the next one comes after 4 ms
  EXPECT_EQ(clock.Utime(), kStart + 4000);
  EXPECT_FALSE(bus.at_end());
  EXPECT_EQ(bus.HandleUntil(clock.Now() + 3ms), 1);
  EXPECT_TRUE(bus.at_end());
  EXPECT_EQ(clock.Utime(), kStart + 5000);
  EXPECT_EQ(bus.HandleUntil(clock.Now() + 3ms), 0);
  EXPECT_EQ(clock.Utime(), kStart + 8000);
  EXPECT_THAT(times, ElementsAre(0, 1, 5));
}

// Tests that channels without subscribers are skipped, that taps see everything, and that a time going
// backwards in the log does not move the clock back.
TEST(LogBusTest, TapsSeeAllAndTimeNeverGoesBack) {
  const std::vector<Event> events = {StateEvent(2), StateEvent(1, "OTHER"), StateEvent(3)};
  SimulatedClock clock;
  LogBus only_states(Source(events), {.clock = &clock});
  int states = 0;
  only_states.Subscribe<state_t>("STATE", [&](const state_t&) { ++states; });
  while (!only_states.at_end()) only_states.HandleUntil(clock.Now() + 1s);
  EXPECT_EQ(states, 2);

  SimulatedClock tap_clock;
  LogBus tapped(Source(events), {.clock = &tap_clock});
  std::vector<std::string> seen;
  tapped.SubscribeAll([&](const RawMessage& message) {
    EXPECT_GE(tap_clock.Utime(), kStart + 2000);
    seen.push_back(std::string(message.channel) + std::to_string((message.receive_utime - kStart) / 1000));
  });
  while (!tapped.at_end()) EXPECT_EQ(tapped.HandleUntil(tap_clock.Now() + 1s), 1);
  EXPECT_THAT(seen, ElementsAre("STATE2", "OTHER1", "STATE3"));
}

// Tests that what the application publishes goes to the comparison, with its type, and does not come back.
TEST(LogBusTest, PublishedGoesToTheComparison) {
  const std::vector<Event> events = {StateEvent(0), StateEvent(1)};
  SimulatedClock clock;
  std::vector<int64_t> commands;
  LogBus bus(Source(events),
             {.clock = &clock,
              .published = [&](const std::string& channel, const MessageType& type, const void* message) {
                EXPECT_EQ(channel, "COMMAND");
                ASSERT_EQ(type.hash, motor_command_t::getHash());
                commands.push_back(static_cast<const motor_command_t*>(message)->tick);
              }});
  Publisher<motor_command_t> publisher = bus.Advertise<motor_command_t>("COMMAND");
  bus.Subscribe<state_t>("STATE", [&](const state_t& state) {
    motor_command_t command{};
    command.tick = state.tick;
    publisher.Send(command);
  });
  bus.Subscribe<motor_command_t>("COMMAND", [](const motor_command_t&) { ADD_FAILURE(); });
  while (!bus.at_end()) bus.HandleUntil(clock.Now() + 1s);
  EXPECT_THAT(commands, ElementsAre(0, 1));
}

// Tests that undecodable events are counted and skipped, and that the replay goes on after a handler throws.
TEST(LogBusTest, SurvivesBadEventsAndHandlers) {
  std::vector<Event> events = {StateEvent(0), StateEvent(1), StateEvent(2)};
  events[1].bytes.pop_back();
  SimulatedClock clock;
  LogBus bus(Source(events), {.clock = &clock});
  std::vector<int64_t> ticks;
  bus.Subscribe<state_t>("STATE", [&](const state_t& state) {
    ticks.push_back(state.tick);
    if (state.tick == 0) throw std::runtime_error("tick 0");
  });
  EXPECT_THROW(bus.HandleUntil(clock.Now()), std::runtime_error);
  EXPECT_EQ(bus.HandleUntil(clock.Now() + 1s), 1);
  EXPECT_TRUE(bus.at_end());
  EXPECT_THAT(ticks, ElementsAre(0, 2));
  EXPECT_EQ(bus.undecodable(), 1);
}

// Tests that an empty log is at its end from the start, and that impossible speeds are refused.
TEST(LogBusTest, EmptyLogAndBadSpeed) {
  const std::vector<Event> none;
  SimulatedClock clock;
  EXPECT_TRUE(LogBus(Source(none), {.clock = &clock}).at_end());
  EXPECT_THROW(LogBus(Source(none), {.speed = -1}), std::invalid_argument);
  EXPECT_THROW(LogBus(Source(none), {.clock = &clock, .speed = 1}), std::invalid_argument);
}

// Tests that on a wall clock events come no earlier than their time in the log divided by the speed.
TEST(LogBusTest, KeepsPaceOnAWallClock) {
  const std::vector<Event> events = {StateEvent(0), StateEvent(40)};
  const auto start = std::chrono::steady_clock::now();
  LogBus bus(Source(events), {.speed = 4});
  bus.Subscribe<state_t>("STATE", [](const state_t&) {});
  while (!bus.at_end()) bus.HandleUntil(std::chrono::steady_clock::now() + 1s);
  EXPECT_GE(std::chrono::steady_clock::now() - start, 10ms);
}

}  // namespace
}  // namespace hydro::bus
