// UdpmBus with a key, over the network: the buses of two processes, and an intruder's without a key.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hydro/motor_command_t.hpp>
#include <memory>
#include <string>
#include <vector>

#include "bus/udpm/open_udpm_bus.h"
#include "tests/free_udp_port.h"

namespace hydro::bus {
namespace {

using namespace std::chrono_literals;
using testing::Each;
using testing::ElementsAre;

const std::string kCommand = "COMMAND";

std::unique_ptr<Authenticator> MakeOne(uint8_t key_byte) {
  std::array<uint8_t, kBusKeySize> bytes{};
  bytes.fill(key_byte);
  return std::make_unique<Authenticator>(BusKey(bytes),
                                         std::vector<std::string>{"INTRODUCTION", kCommand, "SECOND"});
}

class AuthenticatedBusTest : public testing::Test {
 protected:
  // The bus of a process with that key; 0: without a key.
  UdpmBus& Open(uint8_t key_byte = 0) {
    return *opened_.emplace_back(OpenUdpmBus(url_, key_byte == 0 ? nullptr : MakeOne(key_byte)));
  }
  template <class Done>
  static void HandleWhileNot(const std::vector<UdpmBus*>& buses, Done done) {
    const auto give_up = std::chrono::steady_clock::now() + 10s;
    while (!done() && std::chrono::steady_clock::now() < give_up) {
      for (UdpmBus* bus : buses) bus->HandleUntil(std::chrono::steady_clock::now() + 2ms);
    }
  }
  static motor_command_t CommandOf(int64_t tick) {
    motor_command_t command{};
    command.tick = tick;
    return command;
  }
  // Sends until one arrives: those sent before the introduction do not.
  void Meet(UdpmBus& sender, const std::vector<UdpmBus*>& buses) {
    HandleWhileNot(buses, [&] {
      if (ticks_.empty()) sender.Publish(kCommand, CommandOf(0));
      return !ticks_.empty();
    });
    ASSERT_THAT(ticks_, Each(0));
    HandleWhileNot(buses, [&, quiet = 0]() mutable { return ++quiet > 10; });
    ticks_.clear();
  }
  void Follow(UdpmBus& bus) {
    bus.Subscribe<motor_command_t>(kCommand, [this](const motor_command_t& c) { ticks_.push_back(c.tick); });
  }

  std::string url_ = FreeBusUrl();
  std::vector<int64_t> ticks_;
  std::vector<std::unique_ptr<UdpmBus>> opened_;
};

// Tests that commands arrive once and in order, and that an intruder's commands among them are refused and
// counted.
TEST_F(AuthenticatedBusTest, IntruderIsRefused) {
  UdpmBus &plant = Open(1), &loop = Open(1), &stranger = Open(2), &intruder = Open();
  Follow(plant);
  loop.Subscribe<motor_command_t>("SECOND", [](const motor_command_t&) {});
  stranger.Subscribe<motor_command_t>("SECOND", [](const motor_command_t&) {});
  const std::vector<UdpmBus*> buses = {&plant, &loop, &stranger};
  Meet(loop, buses);
  const int64_t before = plant.refused().wrong_seal;
  EXPECT_EQ(plant.refused().unsealed, 0);
  for (int64_t tick = 1; tick <= 50; ++tick) {
    intruder.Publish(kCommand, CommandOf(-tick));
    stranger.Publish(kCommand, CommandOf(-tick));
    loop.Publish(kCommand, CommandOf(tick));
  }
  HandleWhileNot(buses, [&] { return ticks_.size() >= 50; });
  ASSERT_EQ(ticks_.size(), 50u);
  for (size_t i = 0; i < 50; ++i) EXPECT_EQ(ticks_[i], static_cast<int64_t>(i + 1));
  EXPECT_EQ(plant.refused().unsealed, 50);
  EXPECT_GE(plant.refused().wrong_seal, before + 50);
  EXPECT_EQ(plant.refused().last_channel, kCommand);
  EXPECT_EQ(plant.undecodable(), 0);
  EXPECT_EQ(intruder.refused().total(), 0) << "without a key nothing is refused";
}

// Tests that every subscriber of a channel gets a message, though the message counts once.
TEST_F(AuthenticatedBusTest, EverySubscriberIsServed) {
  UdpmBus &plant = Open(1), &loop = Open(1);
  std::vector<std::string> calls;
  plant.Subscribe<motor_command_t>(kCommand, [&](const motor_command_t&) { calls.push_back("first"); });
  Follow(plant);
  loop.Subscribe<motor_command_t>("SECOND", [](const motor_command_t&) {});
  Meet(loop, {&plant, &loop});
  calls.clear();
  loop.Publish(kCommand, CommandOf(1));
  HandleWhileNot({&plant, &loop}, [&] { return !ticks_.empty(); });
  EXPECT_THAT(ticks_, ElementsAre(1));
  EXPECT_THAT(calls, ElementsAre("first"));
  EXPECT_EQ(plant.refused().total(), 0);
}

// Tests that the record holds the plain message, that it includes a new sender's first messages although they
// came before its introduction, and that refused messages are in it under another name.
TEST_F(AuthenticatedBusTest, RecordsPlainMessages) {
  UdpmBus &logger = Open(1), &intruder = Open();
  std::vector<std::string> record;
  logger.SubscribeAll([&](const RawMessage& message) {
    motor_command_t command{};
    if (command.decode(message.data, 0, message.size) != message.size) return;
    record.push_back(std::string(message.channel) + " " + std::to_string(command.tick));
  });
  UdpmBus& loop = Open(1);
  loop.Subscribe<motor_command_t>("SECOND", [](const motor_command_t&) {});
  for (int64_t tick = 0; tick < 3; ++tick) loop.Publish(kCommand, CommandOf(tick));
  intruder.Publish(kCommand, CommandOf(100));
  intruder.Publish("FREE", CommandOf(101));
  HandleWhileNot({&logger, &loop}, [&] { return record.size() >= 5; });
  EXPECT_THAT(record, testing::UnorderedElementsAre("COMMAND 0", "COMMAND 1", "COMMAND 2",
                                                    "REFUSED_COMMAND 100", "FREE 101"));
}

// Tests that a process that starts later does not obey a recording, sealed messages included, and records it
// as refused.
TEST_F(AuthenticatedBusTest, RecordingIsRefused) {
  std::vector<std::pair<std::string, std::vector<uint8_t>>> recording;
  {
    UdpmBus& wire = Open();  // without a key: sees the raw messages
    wire.SubscribeAll([&](const RawMessage& message) {
      recording.push_back({std::string(message.channel), {message.data, message.data + message.size}});
    });
    UdpmBus &plant = Open(1), &loop = Open(1);
    Follow(plant);
    loop.Subscribe<motor_command_t>("SECOND", [](const motor_command_t&) {});
    Meet(loop, {&plant, &loop, &wire});
    for (int64_t tick = 1; tick < 20; ++tick) loop.Publish(kCommand, CommandOf(tick));
    HandleWhileNot({&plant, &loop, &wire}, [&] { return ticks_.size() >= 19; });
    ASSERT_EQ(ticks_.size(), 19u);
    HandleWhileNot({&wire}, [quiet = 0]() mutable { return ++quiet > 10; });
  }
  opened_.clear();
  ASSERT_GT(recording.size(), 22u);
  ticks_.clear();
  UdpmBus &plant = Open(1), &player = Open();
  int refused = 0;
  plant.SubscribeAll([&](const RawMessage& message) { refused += message.channel == "REFUSED_COMMAND"; });
  Follow(plant);
  HandleWhileNot({&plant}, [&] {
    for (const auto& [channel, bytes] : recording) {
      player.PublishRaw(channel, bytes.data(), static_cast<int>(bytes.size()));
    }
    return plant.refused().unknown_sender > 100;
  });
  EXPECT_GT(plant.refused().unknown_sender, 100);
  EXPECT_GT(refused, 100);
  EXPECT_THAT(ticks_, ElementsAre());
}

}  // namespace
}  // namespace hydro::bus
