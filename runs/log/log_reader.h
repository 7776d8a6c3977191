// Reads LCM event logs, both ours and lcm-logger's, strictly: anything that is not an event is
// an error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/input_error.h"
#include "base/mapped_file.h"
#include "bus/bus.h"
#include "runs/log/log_verdict.h"

namespace hydro::log {

// The bytes of an LCM event log, as liblcm's lcm_eventlog writes and reads them: a sequence of events, each
//   sync word u32 | event number i64 | timestamp i64 (us) | channel length i32 | data length i32
//   | channel | data
// with all integers big-endian.
constexpr uint32_t kLogSyncWord = 0xEDA1DA01;
constexpr size_t kLogHeaderSize = 28;
constexpr size_t kMaxLogChannelLength = 63;   // LCM's limit on the name of a channel
constexpr size_t kMaxLogDataSize = 1u << 30;  // far above any message, so a greater length is damaged

// The error for a log that is damaged, torn or not a log. what() names the file, the byte, the event, what
// was found and what is allowed.
class LogError : public InputError {
 public:
  using InputError::InputError;
};

// One message of a log. Channel and data are valid as long as the reader that returned it.
struct LogEvent {
  int64_t index = 0;   // place among the log's messages, counted from 0
  int64_t offset = 0;  // byte of the file at which it begins
  int64_t number = 0;  // as the writer numbered it
  int64_t utime = 0;   // us since 1970-01-01 UTC, or simulated time, when it was received
  std::string_view channel;
  const uint8_t* data = nullptr;
  int size = 0;
};

// Decodes an event with or without a seal (bus/seal_trailer.h; lcm-logger records seals). Returns false when
// it is not a complete message of that type.
template <class Message>
bool DecodeAs(const LogEvent& event, Message& message) {
  try {
    return bus::DecodeInto(&message, event.data, event.size);
  } catch (const std::length_error&) {  // the code from lcm-gen trusts a string length of 0 or less
    return false;
  }
}

// Reads the event at `offset`, which must lie before the end. Returns an empty string, or what is wrong:
// "found ...; allowed ...". Does not change `event.index`.
std::string ParseLogEvent(const MappedFile& file, int64_t offset, LogEvent& event);

// The first sync word at or after `from`; the end of the file if there is none.
int64_t NextSyncWord(const MappedFile& file, int64_t from);

// True when `offset` is the end, or a sync word (or as much of one as the file still holds) stands there.
bool LogEventMayBeginAt(const MappedFile& file, int64_t offset);

// True when `offset` may be the beginning of an event that the end of the file cuts off.
bool LogEventIsTornAt(const MappedFile& file, int64_t offset);

// The offset of the first byte after an event.
int64_t EndOf(const LogEvent& event);

// Throws InputError for a file of another kind, and names the program that reads it: repair would only find
// that it is damaged.
void RefuseOtherKinds(const std::string& name, const MappedFile& file);

// What to do where a log is damaged.
enum class OnDamage {
  kThrow,  // throws LogError: for callers that need the whole log
  kStop,   // stops as at the end: for callers that report the damage from the verdict
};

class LogReader {
 public:
  // Opens a log and reads it once to find its verdict. Throws InputError when it cannot be read. An empty
  // file is a log without events.
  explicit LogReader(const std::string& file, OnDamage on_damage = OnDamage::kThrow);

  // Reads the next message; returns false at the end, which in an incomplete log is the end of its last whole
  // event. Check events (log_check.h) are not messages. An event must be followed by the end or by another
  // event, so one with a damaged length is not returned, and neither is one with a wrong checksum. Throws
  // LogError at the first place where this fails.
  bool Next(LogEvent& event);

  // Rewinds to the first event.
  void Rewind() {
    offset_ = 0;
    index_ = 0;
  }

  const LogVerdict& verdict() const { return verdict_; }
  const std::string& file() const { return name_; }
  int64_t size() const { return static_cast<int64_t>(file_.size()); }  // bytes

 private:
  std::string name_;
  MappedFile file_;
  OnDamage on_damage_;
  LogVerdict verdict_;
  int64_t offset_ = 0;
  int64_t index_ = 0;
};

}  // namespace hydro::log
