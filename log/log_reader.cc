#include "log/log_reader.h"

#include <algorithm>
#include <cstring>

#include "base/number_text.h"
#include "log/log_format.h"

namespace hydro::log {
namespace {

std::string Hex(uint32_t value) { return HexNumber(value, 8); }

std::string WrongSyncWord(uint32_t found) {
  return "found sync word " + Hex(found) + "; allowed " + Hex(kLogSyncWord);
}

[[noreturn]] void ThrowDamaged(const std::string& file, int64_t offset, int64_t index,
                               const std::string& what) {
  throw LogError(file + ": byte " + std::to_string(offset) + ", event " + std::to_string(index) + ": " +
                 what + "; hydro-log repair " + file + " keeps what can be read");
}

}  // namespace

std::string ParseLogEvent(const MappedFile& file, int64_t offset, LogEvent& event) {
  const uint8_t* bytes = file.data() + offset;
  const size_t left = file.size() - static_cast<size_t>(offset);
  if (left >= 4 && LoadBigEndian32(bytes) != kLogSyncWord) return WrongSyncWord(LoadBigEndian32(bytes));
  if (left < kLogHeaderSize) {
    return "found " + std::to_string(left) + " bytes before the end of the file; allowed a header of " +
           std::to_string(kLogHeaderSize);
  }
  const int32_t channel_length = static_cast<int32_t>(LoadBigEndian32(bytes + 20));
  if (channel_length < 1 || channel_length > static_cast<int32_t>(kMaxLogChannelLength)) {
    return "found channel length " + std::to_string(channel_length) + "; allowed 1 to " +
           std::to_string(kMaxLogChannelLength);
  }
  const int32_t size = static_cast<int32_t>(LoadBigEndian32(bytes + 24));
  if (size < 0 || size > static_cast<int32_t>(kMaxLogDataSize)) {
    return "found data length " + std::to_string(size) + "; allowed 0 to " + std::to_string(kMaxLogDataSize);
  }
  const size_t body = static_cast<size_t>(channel_length) + static_cast<size_t>(size);
  if (body > left - kLogHeaderSize) {
    return "found " + std::to_string(left - kLogHeaderSize) +
           " bytes of channel and data before the end of the file; the header announces " +
           std::to_string(body);
  }
  const char* channel = reinterpret_cast<const char*>(bytes + kLogHeaderSize);
  event.channel = std::string_view(channel, static_cast<size_t>(channel_length));
  if (event.channel.find('\0') != std::string_view::npos) {
    return "found a zero byte in the channel's name; allowed any other";
  }
  event.offset = offset;
  event.number = static_cast<int64_t>(LoadBigEndian64(bytes + 4));
  event.utime = static_cast<int64_t>(LoadBigEndian64(bytes + 12));
  event.data = bytes + kLogHeaderSize + channel_length;
  event.size = size;
  return {};
}

bool LogEventMayBeginAt(const MappedFile& file, int64_t offset) {
  uint8_t sync[4];
  StoreBigEndian32(kLogSyncWord, sync);
  const size_t left = file.size() - static_cast<size_t>(offset);
  return left == 0 || std::memcmp(file.data() + offset, sync, std::min<size_t>(left, 4)) == 0;
}

int64_t EndOf(const LogEvent& event) {
  return event.offset + static_cast<int64_t>(kLogHeaderSize + event.channel.size()) + event.size;
}

bool LogReader::Next(LogEvent& event) {
  if (offset_ == size()) return false;
  const std::string wrong = ParseLogEvent(file_, offset_, event);
  if (!wrong.empty()) ThrowDamaged(name_, offset_, index_, wrong);
  const int64_t end = EndOf(event);
  if (!LogEventMayBeginAt(file_, end)) {
    // Only what follows an event reveals a damaged length; then the event itself cannot be trusted either.
    LogEvent next;
    ThrowDamaged(name_, end, index_ + 1, ParseLogEvent(file_, end, next));
  }
  event.index = index_++;
  offset_ = end;
  return true;
}

}  // namespace hydro::log
