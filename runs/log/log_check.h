// Check events: what a log says of itself, so that damage is noticed (docs/logs.md).
//
// They are events of the log on a channel of their own. Each holds the checksums of the events since the one
// before it; the first opens the log and the last ends it. LCM's tools read past them: lcm-logplayer picks
// channels with ".*", in which the point does not match the line feed that the channel begins with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "runs/log/log_reader.h"

namespace hydro::log {

inline constexpr std::string_view kCheckChannel = "\nLOG_CHECK";
inline constexpr std::string_view kCheckMagic = "HYDROCHK";  // what the data of a check event begin with
inline constexpr uint8_t kCheckVersion = 1;
inline constexpr size_t kMostCheckedEvents = 128;   // between two check events
inline constexpr size_t kMostCheckedBytes = 16384;  // the same, reached by the last event between them
inline constexpr size_t kMostCheckText = 60000;     // bytes

// How the text of a kEnd begins where the recording goes on in another file.
inline constexpr std::string_view kGoesOn = "goes on in ";

enum class CheckKind : uint8_t {
  kBegin,  // opens a log; its text says where it comes from, if not from a recording
  kBlock,  // between; its text is a remark of the recorder
  kEnd,    // ends a log; its text says why, if not because the recording was finished
};

// The contents of a check event. The views lie in its bytes.
struct LogCheck {
  CheckKind kind = CheckKind::kBlock;
  int64_t offset = 0;     // of the check event in its log, in bytes from the log's kBegin
  uint32_t previous = 0;  // `checksum` of the check event before. In kBegin: of the end of the part that
                          // this one follows (rotation); 0: of none
  size_t count = 0;       // events since then
  const uint8_t* checksums = nullptr;  // of those, big-endian u32 each
  std::string_view text;
  uint32_t checksum = 0;  // of the check event itself, up to this field
  bool sound = false;     // that checksum is right

  uint32_t ChecksumAt(size_t k) const;
};

// CRC-32 (that of zlib, gzip and PNG) of `size` bytes.
uint32_t Checksum(const uint8_t* bytes, size_t size);

// CRC-32 of a whole event, header included.
uint32_t ChecksumOf(const LogEvent& event);

inline bool IsCheck(const LogEvent& event) { return event.channel == kCheckChannel; }

// Whether an event on another channel has the contents of a check event: then the channel's name is damaged.
bool IsDisguisedCheck(const LogEvent& event);

// Reads a check event; none where its lengths contradict each other. Throws InputError for a sound one of a
// later version.
std::optional<LogCheck> ParseCheck(const LogEvent& event);

// How long the data of a check event are.
size_t CheckDataSize(size_t count, size_t text_size);

// Writes the data of a check event; `event` is where its header begins, which is complete, like the channel.
// Returns its checksum.
uint32_t WriteCheckData(const LogCheck& check, uint8_t* event, uint8_t* data);

}  // namespace hydro::log
