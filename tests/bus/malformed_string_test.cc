#include <gtest/gtest.h>

#include <algorithm>
#include <hydro/fault_t.hpp>
#include <limits>
#include <vector>

#include "bus/bus.h"
#include "bus/messages.h"

namespace hydro::bus {
namespace {

// Tests that a string length that no encoder writes (0, negative, beyond the message) makes the message
// undecodable and does nothing worse: network input is not trusted.
TEST(MalformedStringTest, BadLengthsAreRefused) {
  fault_t fault{};
  fault.source = "plant";
  std::vector<uint8_t> bytes(static_cast<size_t>(fault.getEncodedSize()));
  const int size = static_cast<int>(bytes.size());
  ASSERT_EQ(fault.encode(bytes.data(), 0, size), size);
  const MessageType& type = TypeOf<fault_t>();
  ASSERT_NE(type.decode(bytes.data(), size), nullptr);
  constexpr size_t kLengthOffset = 40;     // after hash, utime, tick, session, sequence
  ASSERT_EQ(bytes[kLengthOffset + 3], 6);  // "plant" and its terminating 0
  for (const int32_t length :
       {0, -1, -1000, std::numeric_limits<int32_t>::min(), std::numeric_limits<int32_t>::max(), size}) {
    const auto bits = static_cast<uint32_t>(length);
    for (size_t i = 0; i < 4; ++i) bytes[kLengthOffset + i] = static_cast<uint8_t>(bits >> (24 - 8 * i));
    EXPECT_EQ(type.decode(bytes.data(), size), nullptr) << length;
    fault_t into;
    EXPECT_FALSE(type.decode_into(&into, bytes.data(), size)) << length;
  }
}

// Tests that a string with a zero byte inside makes the message undecodable: LCM would cut it there when the
// receiver repeats it, and what is encoded then is not what was said.
TEST(MalformedStringTest, AZeroByteInsideIsRefused) {
  fault_t fault{};
  fault.text = "no state";
  std::vector<uint8_t> bytes(static_cast<size_t>(fault.getEncodedSize()));
  const int size = static_cast<int>(bytes.size());
  ASSERT_EQ(fault.encode(bytes.data(), 0, size), size);
  const auto blank = std::find(bytes.begin(), bytes.end(), ' ');
  ASSERT_NE(blank, bytes.end());
  *blank = 0;
  const MessageType& type = TypeOf<fault_t>();
  EXPECT_EQ(type.decode(bytes.data(), size), nullptr);
  fault_t into;
  EXPECT_FALSE(type.decode_into(&into, bytes.data(), size));
}

// A message of the type with an element in its array of strings, if it has one.
template <class Message>
Message Example() {
  Message message{};
  if constexpr (requires { message.names; }) {
    message.count = 2;
    message.names = {"pressure.k_p", "position.c1"};
    message.values = {1, 2};
  }
  return message;
}

// Decodes the message with each number of 32 bits in it replaced: whatever is a length somewhere gets a value
// that no encoder writes. A message that decodes can be sent on.
template <class Message>
void ExpectNoHarm(std::string_view channel) {
  const Message message = Example<Message>();
  std::vector<uint8_t> sound(static_cast<size_t>(message.getEncodedSize()));
  const int size = static_cast<int>(sound.size());
  ASSERT_EQ(message.encode(sound.data(), 0, size), size) << channel;
  ASSERT_NE(TypeOf<Message>().decode(sound.data(), size), nullptr) << channel;
  for (size_t at = 8; at + 4 <= sound.size(); ++at) {
    for (const int32_t length :
         {0, -1, -7, std::numeric_limits<int32_t>::min(), std::numeric_limits<int32_t>::max(), size}) {
      std::vector<uint8_t> bytes = sound;
      for (size_t i = 0; i < 4; ++i)
        bytes[at + i] = static_cast<uint8_t>(static_cast<uint32_t>(length) >> (24 - 8 * i));
      Message into;
      bool decoded = false;
      EXPECT_NO_THROW(decoded = TypeOf<Message>().decode_into(&into, bytes.data(), size))
          << channel << ", " << length << " at byte " << at;
      if (decoded) {
        EXPECT_EQ(into.getEncodedSize(), size) << channel << ", " << length << " at byte " << at;
      }
    }
  }
}

// Tests the same of every message that there is, and of every place in it, elements of arrays included.
TEST(MalformedStringTest, NoLengthInAnyMessageDoesHarm) {
  std::apply(
      [](const auto&... row) {
        (ExpectNoHarm<typename std::remove_cvref_t<decltype(row)>::Type>(row.channel), ...);
      },
      kMessages);
}

}  // namespace
}  // namespace hydro::bus
