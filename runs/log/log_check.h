// Check events: the log's record of its own contents, which reveals damage (docs/logs.md).
//
// They are events of the log on a channel of their own. Each holds the checksums of the events since the
// check event before it; the first one opens the log and the last one ends it. LCM's tools skip them:
// lcm-logplayer picks channels with ".*", in which the point does not match the line feed with which the
// channel's name begins.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "runs/log/log_reader.h"

namespace hydro::log {

inline constexpr std::string_view kCheckChannel = "\nLOG_CHECK";
inline constexpr std::string_view kCheckMagic = "HYDROCHK";  // the first bytes of a check event's data
inline constexpr uint8_t kCheckVersion = 1;
inline constexpr size_t kMostCheckedEvents = 128;   // between two check events
inline constexpr size_t kMostCheckedBytes = 16384;  // bytes; the last event between them reaches it
inline constexpr size_t kMostCheckText = 60000;     // bytes

// How the text of a kEnd begins when the recording continues in another file.
inline constexpr std::string_view kGoesOn = "goes on in ";

enum class CheckKind : uint8_t {
  kBegin,  // opens a log; its text says where the log comes from, if not from a recording
  kBlock,  // stands in between; its text is a remark of the recorder
  kEnd,    // ends a log; its text says why, if not because the recording was finished
};

// The contents of a check event. The views point into its bytes.
struct LogCheck {
  CheckKind kind = CheckKind::kBlock;
  int64_t offset = 0;     // of the check event in its log, in bytes from the log's kBegin
  uint32_t previous = 0;  // `checksum` of the check event before. In kBegin: of the end of the part that
                          // this one follows (rotation); 0: of none
  size_t count = 0;       // events since the check event before
  const uint8_t* checksums = nullptr;  // of those events, big-endian u32 each
  std::string_view text;
  uint32_t checksum = 0;  // of the check event itself, up to this field
  bool sound = false;     // whether that checksum is right

  uint32_t ChecksumAt(size_t k) const;
};

// CRC-32 (that of zlib, gzip and PNG) of `size` bytes.
uint32_t Checksum(const uint8_t* bytes, size_t size);

// CRC-32 of a whole event, header included.
uint32_t ChecksumOf(const LogEvent& event);

inline bool IsCheck(const LogEvent& event) { return event.channel == kCheckChannel; }

// Whether an event on another channel has the contents of a check event. If so, the channel's name is
// damaged.
bool IsDisguisedCheck(const LogEvent& event);

// Reads a check event; returns nothing where its lengths contradict each other. Throws InputError for a sound
// check event of a later version.
std::optional<LogCheck> ParseCheck(const LogEvent& event);

// The length of a check event's data in bytes.
size_t CheckDataSize(size_t count, size_t text_size);

// Writes the data of a check event; `event` is where its header begins. Header and channel must be complete.
// Returns its checksum.
uint32_t WriteCheckData(const LogCheck& check, uint8_t* event, uint8_t* data);

}  // namespace hydro::log
