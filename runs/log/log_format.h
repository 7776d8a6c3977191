// The bytes of an LCM event log, as liblcm's lcm_eventlog writes and reads them: a sequence of events, each
//   sync word u32 | event number i64 | timestamp i64 (us) | channel length i32 | data length i32
//   | channel | data
// with all integers big-endian.
#pragma once

#include <cstddef>
#include <cstdint>

namespace hydro::log {

constexpr uint32_t kLogSyncWord = 0xEDA1DA01;
constexpr size_t kLogHeaderSize = 28;
constexpr size_t kMaxLogChannelLength = 63;   // LCM's limit on the name of a channel
constexpr size_t kMaxLogDataSize = 1u << 30;  // far above any message, so a greater length is damaged

}  // namespace hydro::log
