#include "bus/messages.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "bus/channels.h"

namespace hydro::bus {
namespace {

template <class Message>
std::vector<uint8_t> Encoded(const Message& message) {
  std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

int64_t At(const std::vector<uint8_t>& bytes, int place) {
  uint64_t value = 0;
  for (size_t i = 0; i < 8; ++i) value = value << 8 | bytes.at(static_cast<size_t>(place) + i);
  return static_cast<int64_t>(value);
}

// Tests that each type and each channel has one row.
TEST(MessagesTest, RowsAreUnique) {
  std::set<std::string> types, channels;
  ForEachMessage([&]<class Message>(const MessageRow<Message>& row) {
    types.insert(Message::getTypeName());
    channels.insert(std::string(row.channel));
    EXPECT_TRUE(row.channel.starts_with("HYDRO_")) << row.channel;
    EXPECT_FALSE(row.sender.empty()) << row.channel;
    EXPECT_EQ(&RowOf<Message>(), &row);
  });
  EXPECT_EQ(types.size(), kMessageCount);
  EXPECT_EQ(channels.size(), kMessageCount);
}

// Tests for each type that the offsets of its numbers are those in the encoded message.
TEST(MessagesTest, NumbersAreWhereTheTableSays) {
  ForEachMessage([]<class Message>(const MessageRow<Message>& row) {
    Message message{};
    constexpr NumberPlaces kPlaces = PlacesOf<Message>();
    if constexpr (kPlaces.tick >= 0) message.tick = -0x0102030405060708;
    if constexpr (kPlaces.session >= 0) message.session = 0x1112131415161718;
    if constexpr (kPlaces.sequence >= 0) message.sequence = -0x2122232425262728;
    const std::vector<uint8_t> bytes = Encoded(message);
    if constexpr (kPlaces.tick >= 0) {
      EXPECT_EQ(At(bytes, kPlaces.tick), message.tick) << row.channel;
    }
    if constexpr (kPlaces.session >= 0) {
      EXPECT_EQ(At(bytes, kPlaces.session), message.session) << row.channel;
    }
    if constexpr (kPlaces.sequence >= 0) {
      EXPECT_EQ(At(bytes, kPlaces.sequence), message.sequence) << row.channel;
    }
  });
  EXPECT_EQ(PlacesOf<state_t>().sequence, 32);
  EXPECT_EQ(PlacesOf<rearm_t>().sequence, -1);
  EXPECT_EQ(PlacesOf<loop_statistics_t>().tick, -1);
}

// Tests that numbers are read only from the loops' messages, on this stack's channels, and only from whole
// ones.
TEST(MessagesTest, ReadsLoopNumbers) {
  const Channels channels("_2");
  int parts = 0;
  ForEachMessage([&]<class Message>(const MessageRow<Message>& row) {
    Message message{};
    if constexpr (requires { message.tick; }) message.tick = 812;
    message.session = 77;
    if constexpr (requires { message.sequence; }) message.sequence = 5;
    const std::vector<uint8_t> bytes = Encoded(message);
    const auto read = [&](const std::string& channel, size_t size) {
      return ReadLoopNumbers({channel, bytes.data(), static_cast<int>(size), 0}, channels);
    };
    const auto numbers = read(channels.Of<Message>(), bytes.size());
    ASSERT_EQ(numbers.has_value(), row.part != LoopPart::kNone) << row.channel;
    if (!numbers) return;
    ++parts;
    EXPECT_EQ(numbers->part, row.part);
    EXPECT_EQ(numbers->tick, 812);
    EXPECT_EQ(numbers->session, 77);
    EXPECT_EQ(numbers->sequence, 5);
    EXPECT_FALSE(read(std::string(row.channel), bytes.size())) << "another stack's";
    EXPECT_FALSE(read(channels.Of<Message>(), 39)) << "cut off";
    EXPECT_TRUE(read(channels.Of<Message>(), 40));
  });
  EXPECT_EQ(parts, 4);
}

}  // namespace
}  // namespace hydro::bus
