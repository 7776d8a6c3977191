// The contract of bus.h, which every transport must keep.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "bus/channels.h"
#include "bus/in_process_bus.h"
#include "bus/udpm/open_udpm_bus.h"
#include "hydro/motor_command_t.hpp"
#include "hydro/run_description_t.hpp"
#include "hydro/state_t.hpp"
#include "tests/free_udp_port.h"

namespace hydro::bus {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

constexpr const char* kIntroductions = "INTRODUCTIONS";

struct Transport {
  std::string name;
  bool simulated;
  std::function<std::unique_ptr<Bus>(SimulatedClock*)> make;
};

std::ostream& operator<<(std::ostream& out, const Transport& transport) { return out << transport.name; }

class BusContractTest : public testing::TestWithParam<Transport> {
 protected:
  // Handles messages until `done` says so; gives up after a long while, so that the test fails on what is
  // missing.
  template <class Done>
  void HandleWhileNot(Done done) {
    const auto give_up = std::chrono::steady_clock::now() + 10s;
    while (!done() && std::chrono::steady_clock::now() < give_up) bus_->HandleUntil(Soon(20ms));
  }

  // Handles late arrivals after everything expected has come: for tests that something does not come.
  void HandleRest() {
    while (bus_->HandleUntil(Soon(50ms)) > 0) {
    }
  }

  Bus::TimePoint Soon(std::chrono::nanoseconds delay) const {
    return (GetParam().simulated ? clock_.Now() : std::chrono::steady_clock::now()) + delay;
  }

  void SendStates(const std::string& channel, int count) {
    for (int i = 0; i < count; ++i) {
      state_t state{};
      state.tick = i;
      bus_->Publish(channel, state);
    }
  }

  SimulatedClock clock_;
  std::unique_ptr<Bus> bus_ = GetParam().make(&clock_);
};

// Tests that messages on one channel arrive complete and in order with many of them waiting at once: more
// than LCM's own queue of 30 holds, fewer than the smallest usual receive buffer.
TEST_P(BusContractTest, KeepsOrder) {
  std::vector<int64_t> ticks;
  bus_->Subscribe<state_t>("STATE", [&](const state_t& state) { ticks.push_back(state.tick); });
  for (size_t round = 1; round <= 20; ++round) {
    SendStates("STATE", 150);
    HandleWhileNot([&] { return ticks.size() >= round * 150; });
    ASSERT_EQ(ticks.size(), round * 150);
  }
  for (size_t i = 0; i < ticks.size(); ++i) ASSERT_EQ(ticks[i], static_cast<int64_t>(i % 150));
}

// Tests that every field, strings and special doubles included, arrives as it was sent.
TEST_P(BusContractTest, CarriesEveryField) {
  run_description_t sent{};
  sent.session = -5;
  sent.config_text = std::string(100'000, 'x') + "\n\"end\"";  // more than one packet
  sent.rate_hz = 1e-310;
  std::vector<run_description_t> received;
  bus_->Subscribe<run_description_t>("RUN", [&](const run_description_t& run) { received.push_back(run); });
  bus_->Publish("RUN", sent);
  HandleWhileNot([&] { return !received.empty(); });
  ASSERT_EQ(received.size(), 1u);
  EXPECT_EQ(received[0].session, -5);
  EXPECT_EQ(received[0].config_text, sent.config_text);
  EXPECT_EQ(received[0].rate_hz, 1e-310);
}

// Tests that no handler runs inside Publish(), and that messages a handler publishes come in a later turn.
TEST_P(BusContractTest, HandlersRunOnlyInHandleUntil) {
  std::vector<std::string> events;
  bool handling = false;
  bus_->Subscribe<state_t>("STATE", [&](const state_t& state) {
    EXPECT_TRUE(handling);
    events.push_back("state begins");
    motor_command_t command{};
    command.tick = state.tick;
    bus_->Publish("COMMAND", command);
    events.push_back("state ends");
  });
  bus_->Subscribe<motor_command_t>("COMMAND", [&](const motor_command_t& command) {
    EXPECT_TRUE(handling);
    events.push_back("command " + std::to_string(command.tick));
  });
  SendStates("STATE", 1);
  EXPECT_TRUE(events.empty());
  handling = true;
  HandleWhileNot([&] { return events.size() >= 3; });
  EXPECT_THAT(events, ElementsAre("state begins", "state ends", "command 0"));
}

// Tests that handlers which answer each other go on over many turns, with each HandleUntil() returning.
TEST_P(BusContractTest, HandlersPublishBackAndForth) {
  int64_t last = -1;
  bus_->Subscribe<state_t>("PING", [&](const state_t& state) { bus_->Publish("PONG", state); });
  bus_->Subscribe<state_t>("PONG", [&](const state_t& state) {
    last = state.tick;
    state_t next = state;
    ++next.tick;
    bus_->Publish("PING", next);
  });
  SendStates("PING", 1);
  HandleWhileNot([&] { return last >= 100; });
  EXPECT_GE(last, 100);
}

// Tests that an exception leaves HandleUntil(), skips only that message's other handlers, and leaves the bus
// working.
TEST_P(BusContractTest, ExceptionsLeaveHandleUntil) {
  std::vector<int64_t> ticks;
  bus_->Subscribe<state_t>("STATE", [&](const state_t& state) {
    if (state.tick == 1) throw std::runtime_error("tick 1");
    ticks.push_back(state.tick);
  });
  SendStates("STATE", 3);
  int thrown = 0;
  const auto give_up = std::chrono::steady_clock::now() + 10s;
  while (ticks.size() < 2 && std::chrono::steady_clock::now() < give_up) {
    try {
      bus_->HandleUntil(Soon(20ms));
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "tick 1");
      ++thrown;
    }
  }
  EXPECT_EQ(thrown, 1);
  EXPECT_THAT(ticks, ElementsAre(0, 2));
}

// Tests that messages of another type, truncated ones and noise are counted and never delivered.
TEST_P(BusContractTest, CountsUndecodable) {
  int states = 0;
  bus_->Subscribe<state_t>("STATE", [&](const state_t&) { ++states; });
  state_t state{};
  std::vector<uint8_t> bytes(state.getEncodedSize());
  state.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  const int size = static_cast<int>(bytes.size());
  bus_->Publish("STATE", motor_command_t{});
  for (int i = 1; i < size; ++i) bus_->PublishRaw("STATE", bytes.data(), i);
  bytes.push_back(0);
  bus_->PublishRaw("STATE", bytes.data(), size + 1);  // one byte too many
  bus_->PublishRaw("STATE", bytes.data(), size);
  HandleWhileNot([&] { return states > 0; });
  EXPECT_EQ(states, 1);
  EXPECT_EQ(bus_->undecodable(), size + 1);
}

// Tests that SubscribeAll() sees the bytes of every message on every channel, subscribed elsewhere or not.
TEST_P(BusContractTest, TapSeesAll) {
  std::vector<std::string> seen;
  bus_->Subscribe<state_t>("STATE", [](const state_t&) {});
  bus_->SubscribeAll([&](const RawMessage& message) {
    if (message.channel == kIntroductions) return;  // a bus with a key sends some by itself
    EXPECT_GE(message.receive_utime, 0);
    state_t state{};
    const bool decoded = state.decode(message.data, 0, message.size) == message.size;
    seen.push_back(std::string(message.channel) + " " + (decoded ? std::to_string(state.tick) : "?"));
  });
  SendStates("STATE", 2);
  SendStates("nobody.subscribes", 1);
  bus_->PublishRaw("RAW", "abc", 3);
  HandleWhileNot([&] { return seen.size() >= 4; });
  EXPECT_THAT(seen, ElementsAre("STATE 0", "STATE 1", "nobody.subscribes 0", "RAW ?"));
}

// Tests that raw bytes and advertised channels reach typed subscribers in order, as Publish() does.
TEST_P(BusContractTest, EveryWayOfSendingArrives) {
  std::vector<int64_t> ticks;
  Publisher<state_t> publisher = bus_->Advertise<state_t>("STATE");
  bus_->Subscribe<state_t>("STATE", [&](const state_t& state) { ticks.push_back(state.tick); });
  state_t state{};
  publisher.Send(state);
  state.tick = 1;
  std::vector<uint8_t> bytes(state.getEncodedSize());
  state.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  bus_->PublishRaw("STATE", bytes.data(), static_cast<int>(bytes.size()));
  state.tick = 2;
  bus_->Publish("STATE", state);
  HandleWhileNot([&] { return ticks.size() >= 3; });
  EXPECT_THAT(ticks, ElementsAre(0, 1, 2));
}

// Tests that a channel name is taken literally: a name that looks like a pattern matches only itself.
TEST_P(BusContractTest, ChannelNamesAreNotPatterns) {
  const std::vector<std::string> names = {"A.B",  "AxB", "A*",  "A",  "(A|B)", "B",
                                          "[AB]", "A\\", "^A$", "A+", "A-B#/"};
  std::vector<std::string> seen;
  for (const std::string& name : names) {
    bus_->Subscribe<state_t>(name, [&seen, name](const state_t&) { seen.push_back(name); });
  }
  for (const std::string& name : names) SendStates(name, 1);
  HandleWhileNot([&] { return seen.size() >= names.size(); });
  HandleRest();
  EXPECT_EQ(seen, names);
}

// Tests that stacks with different channel suffixes do not hear each other.
TEST_P(BusContractTest, SuffixesSeparate) {
  const Channels one, two("_2");
  std::vector<std::string> seen;
  bus_->Subscribe<state_t>(one.Of<state_t>(),
                           [&](const state_t& s) { seen.push_back("one " + std::to_string(s.tick)); });
  bus_->Subscribe<state_t>(two.Of<state_t>(),
                           [&](const state_t& s) { seen.push_back("two " + std::to_string(s.tick)); });
  SendStates(one.Of<state_t>(), 1);
  SendStates(two.Of<state_t>(), 2);
  HandleWhileNot([&] { return seen.size() >= 3; });
  HandleRest();
  EXPECT_THAT(seen, ElementsAre("one 0", "two 0", "two 1"));
}

// Tests that every subscriber of a channel is called, in order of subscription.
TEST_P(BusContractTest, AllSubscribersAreCalled) {
  std::vector<int> called;
  for (int i = 0; i < 3; ++i)
    bus_->Subscribe<state_t>("STATE", [&called, i](const state_t&) { called.push_back(i); });
  SendStates("STATE", 1);
  HandleWhileNot([&] { return called.size() >= 3; });
  EXPECT_THAT(called, ElementsAre(0, 1, 2));
}

// Tests that a handler may subscribe, and that the new handler gets later messages.
TEST_P(BusContractTest, HandlersMaySubscribe) {
  int64_t late = -1;
  bool subscribed = false;
  bus_->Subscribe<state_t>("STATE", [&](const state_t&) {
    if (std::exchange(subscribed, true)) return;
    for (int i = 0; i < 100; ++i) bus_->Subscribe<state_t>("LATE", [&](const state_t& s) { late = s.tick; });
  });
  SendStates("STATE", 1);
  HandleWhileNot([&] { return subscribed; });
  SendStates("LATE", 8);
  HandleWhileNot([&] { return late == 7; });
  EXPECT_EQ(late, 7);
}

// Tests that a handler may subscribe to its own channel, and a tap to any: who is new gets the next message,
// and not this one, whether it comes typed or as bytes.
TEST_P(BusContractTest, HandlersMaySubscribeToTheirOwnChannel) {
  std::vector<std::string> heard;
  const auto note = [&](const std::string& who) {
    return [&heard, who](const state_t& state) { heard.push_back(who + " " + std::to_string(state.tick)); };
  };
  bool tapped = false;
  bus_->SubscribeAll([&](const RawMessage& message) {
    if (message.channel != "STATE" || std::exchange(tapped, true)) return;
    bus_->Subscribe<state_t>("STATE", note("by the tap"));
    bus_->SubscribeAll([&](const RawMessage& later) {
      if (later.channel == "STATE") heard.emplace_back("tap");
    });
  });
  bus_->Subscribe<state_t>("STATE", [&](const state_t& state) {
    heard.push_back("first " + std::to_string(state.tick));
    if (state.tick == 0) bus_->Subscribe<state_t>("STATE", note("second"));
  });
  SendStates("STATE", 1);
  HandleWhileNot([&] { return !heard.empty(); });
  HandleRest();
  EXPECT_THAT(heard, ElementsAre("first 0"));
  heard.clear();
  state_t state{};
  state.tick = 1;
  std::vector<uint8_t> bytes(static_cast<size_t>(state.getEncodedSize()));
  state.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  bus_->PublishRaw("STATE", bytes.data(), static_cast<int>(bytes.size()));
  HandleWhileNot([&] { return heard.size() >= 4; });
  HandleRest();
  EXPECT_THAT(heard, testing::UnorderedElementsAre("first 1", "second 1", "by the tap 1", "tap"));
}

// Tests that without messages HandleUntil() returns 0 at the deadline and not before, and at once if it has
// passed.
TEST_P(BusContractTest, ReturnsAtTheDeadline) {
  bus_->Subscribe<state_t>("STATE", [](const state_t&) {});
  const Bus::TimePoint deadline = Soon(3ms);
  EXPECT_EQ(bus_->HandleUntil(deadline), 0);
  EXPECT_GE(Soon(0ms), deadline);
  EXPECT_EQ(bus_->HandleUntil(deadline - 1ms), 0);
  EXPECT_EQ(bus_->HandleUntil(Bus::TimePoint::min()), 0);
  if (GetParam().simulated) {
    EXPECT_EQ(clock_.Now(), deadline);
  }
}

// Tests that waiting messages are handled even when the deadline has passed.
TEST_P(BusContractTest, HandlesWhatWaitsAfterTheDeadline) {
  int states = 0;
  bus_->Subscribe<state_t>("STATE", [&](const state_t&) { ++states; });
  SendStates("STATE", 5);
  const auto give_up = std::chrono::steady_clock::now() + 10s;
  while (states < 5 && std::chrono::steady_clock::now() < give_up) bus_->HandleUntil(Bus::TimePoint::min());
  EXPECT_EQ(states, 5);
}

// Tests that calling HandleUntil() from a handler is an error.
TEST_P(BusContractTest, HandleUntilDoesNotNest) {
  bool thrown = false;
  bus_->Subscribe<state_t>("STATE", [&](const state_t&) {
    try {
      bus_->HandleUntil(Soon(0ms));
    } catch (const std::logic_error&) {
      thrown = true;
    }
  });
  SendStates("STATE", 1);
  HandleWhileNot([&] { return thrown; });
  EXPECT_TRUE(thrown);
}

std::unique_ptr<Authenticator> MakeKeyed() {
  return std::make_unique<Authenticator>(
      BusKey({}), std::vector<std::string>{kIntroductions, "STATE", "COMMAND", "PING", "RUN"});
}

INSTANTIATE_TEST_SUITE_P(
    Transports, BusContractTest,
    testing::Values(Transport{"InProcess", true,
                              [](SimulatedClock* clock) { return std::make_unique<InProcessBus>(clock); }},
                    Transport{"InProcessWall", false,
                              [](SimulatedClock*) { return std::make_unique<InProcessBus>(nullptr); }},
                    Transport{"Udpm", false, [](SimulatedClock*) { return OpenUdpmBus(FreeBusUrl()); }},
                    Transport{"UdpmWithKey", false,
                              [](SimulatedClock*) { return OpenUdpmBus(FreeBusUrl(), MakeKeyed()); }}),
    [](const testing::TestParamInfo<Transport>& param) { return param.param.name; });

}  // namespace
}  // namespace hydro::bus
