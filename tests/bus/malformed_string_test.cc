#include <gtest/gtest.h>

#include <algorithm>
#include <hydro/fault_t.hpp>
#include <limits>
#include <vector>

#include "bus/bus.h"

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

// Tests that a string with a zero byte inside makes the message undecodable: LCM would cut it there when the receiver repeats it,
// and what is encoded then is not what was said.
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

}  // namespace
}  // namespace hydro::bus
