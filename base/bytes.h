// Bytes in memory: numbers in the byte order of messages and logs, most significant byte first, and copies
// of what was written a moment ago.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

namespace hydro {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "these functions swap bytes");

inline uint32_t LoadBigEndian32(const uint8_t* bytes) {
  uint32_t value;
  std::memcpy(&value, bytes, sizeof value);
  return __builtin_bswap32(value);
}

inline uint64_t LoadBigEndian64(const uint8_t* bytes) {
  uint64_t value;
  std::memcpy(&value, bytes, sizeof value);
  return __builtin_bswap64(value);
}

inline void StoreBigEndian32(uint32_t value, uint8_t* bytes) {
  value = __builtin_bswap32(value);
  std::memcpy(bytes, &value, sizeof value);
}

inline void StoreBigEndian64(uint64_t value, uint8_t* bytes) {
  value = __builtin_bswap64(value);
  std::memcpy(bytes, &value, sizeof value);
}

// *to = from, 8 bytes at a time if the value can be copied bytewise. Compilers and memcpy() take 16 bytes and
// more at a time, but a processor cannot serve such a load from two stores that are still under way: it waits
// for them, some 20 cycles, several times a message.
template <class Value>
void CopyFresh(Value* to, const Value& from) {
  if constexpr (std::is_trivially_copyable_v<Value> && sizeof(Value) % 8 == 0) {
    const auto copy = [&](size_t word) {
      uint64_t bits;
      std::memcpy(&bits, reinterpret_cast<const char*>(&from) + 8 * word, 8);
      asm("" : "+r"(bits));  // keeps the compiler from joining two copies
      std::memcpy(reinterpret_cast<char*>(to) + 8 * word, &bits, 8);
    };
    [&]<size_t... word>(std::index_sequence<word...>) { (copy(word), ...); }
    (std::make_index_sequence<sizeof(Value) / 8>());
  } else {
    *to = from;
  }
}

}  // namespace hydro
