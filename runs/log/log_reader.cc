#include "runs/log/log_reader.h"

#include <algorithm>
#include <cstring>

#include "base/bytes.h"
#include "base/file_kind.h"
#include "base/interruption.h"
#include "base/number_text.h"
#include "runs/log/log_check.h"

namespace hydro::log {
namespace {

constexpr std::string_view kTableEndings[] = {".csv", ".tsv", ".txt", ".dat", ".mat"};

std::string Hex(uint32_t value) { return HexNumber(value, 8); }

std::string WrongSyncWord(uint32_t found) {
  return "found sync word " + Hex(found) + "; allowed " + Hex(kLogSyncWord);
}

// Whether the file is a table or another text that was named by mistake, rather than a damaged log.
bool BeginsAsText(const MappedFile& file) {
  constexpr size_t kLooked = 64;
  const size_t size = std::min(file.size(), kLooked);
  return size >= 4 && std::all_of(file.data(), file.data() + size, [](uint8_t c) {
           return (c >= 0x20 && c < 0x7f) || c == '\n' || c == '\r' || c == '\t';
         });
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

int64_t NextSyncWord(const MappedFile& file, int64_t from) {
  const auto size = static_cast<int64_t>(file.size());
  if (from >= size) return size;
  uint8_t sync[4];
  StoreBigEndian32(kLogSyncWord, sync);
  const void* found = memmem(file.data() + from, file.size() - static_cast<size_t>(from), sync, sizeof sync);
  return found == nullptr ? size : static_cast<const uint8_t*>(found) - file.data();
}

bool LogEventMayBeginAt(const MappedFile& file, int64_t offset) {
  uint8_t sync[4];
  StoreBigEndian32(kLogSyncWord, sync);
  const size_t left = file.size() - static_cast<size_t>(offset);
  return left == 0 || std::memcmp(file.data() + offset, sync, std::min<size_t>(left, 4)) == 0;
}

bool LogEventIsTornAt(const MappedFile& file, int64_t offset) {
  if (!LogEventMayBeginAt(file, offset)) return false;
  const uint8_t* bytes = file.data() + offset;
  const size_t left = file.size() - static_cast<size_t>(offset);
  if (left < kLogHeaderSize) return true;
  const uint32_t channel_length = LoadBigEndian32(bytes + 20), size = LoadBigEndian32(bytes + 24);
  return channel_length >= 1 && channel_length <= kMaxLogChannelLength && size <= kMaxLogDataSize &&
         channel_length + size_t{size} > left - kLogHeaderSize;
}

int64_t EndOf(const LogEvent& event) {
  return event.offset + static_cast<int64_t>(kLogHeaderSize + event.channel.size()) + event.size;
}

void RefuseOtherKinds(const std::string& name, const MappedFile& file) {
  constexpr size_t kLooked = 1u << 16;
  const std::string_view beginning(reinterpret_cast<const char*>(file.data()),
                                   std::min(file.size(), kLooked));
  const std::optional<FileKind> kind = FindFileKind(beginning);
  if (kind.has_value() && *kind != FileKind::kLog)
    throw InputError(OtherKind(*kind, name, "an LCM event log"));
  if (!BeginsAsText(file)) return;
  const bool named = std::any_of(std::begin(kTableEndings), std::end(kTableEndings),
                                 [&](std::string_view ending) { return name.ends_with(ending); });
  throw InputError(
      "found text, allowed an LCM event log; hydro-log import " +
      (named ? name + " -o RUN.lcmlog makes one of a table with export's columns"
             : "makes one of a table with export's columns, and hydro-diagnose reads others with a sidecar; "
               "a table has to be named .csv or .mat: rename it"));
}

LogReader::LogReader(const std::string& file, OnDamage on_damage)
    : name_(file), file_(file), on_damage_(on_damage) {
  try {
    RefuseOtherKinds(file, file_);
    verdict_ = ExamineLog(file_);
  } catch (const InputError& error) {
    throw LogError(file + ": " + error.what());
  }
}

bool LogReader::Next(LogEvent& event) {
  while (offset_ < verdict_.readable_end) {
    Interruption::Check();
    ParseLogEvent(file_, offset_, event);
    offset_ = EndOf(event);
    if (IsCheck(event)) continue;
    event.index = index_++;
    return true;
  }
  if (verdict_.completeness != Completeness::kDamaged || on_damage_ == OnDamage::kStop) return false;
  throw LogError(name_ + ": " + verdict_.where + "; hydro-log repair " + name_ + " keeps what can be read");
}

}  // namespace hydro::log
