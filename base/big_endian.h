// Numbers in the byte order of messages and logs: most significant byte first.
#pragma once

#include <cstdint>
#include <cstring>

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

}  // namespace hydro
