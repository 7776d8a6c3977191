// The bytes of an LCM event log, as liblcm's lcm_eventlog writes and reads them: a sequence of events, each
//   sync word u32 | event number i64 | timestamp i64 (us) | channel length i32 | data length i32
//   | channel | data
// with all integers big-endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace hydro::log {

constexpr uint32_t kLogSyncWord = 0xEDA1DA01;
constexpr size_t kLogHeaderSize = 28;
constexpr size_t kMaxLogChannelLength = 63;   // LCM's limit on the name of a channel
constexpr size_t kMaxLogDataSize = 1u << 30;  // far above any message: a greater length is damaged

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

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the loads and stores above swap bytes");

}  // namespace hydro::log
