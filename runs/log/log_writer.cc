#include "runs/log/log_writer.h"

#include <cstring>
#include <stdexcept>
#include <utility>

#include "base/bytes.h"
#include "runs/log/log_reader.h"

namespace hydro::log {
namespace {
constexpr size_t kBufferSize = 1u << 20;
constexpr size_t kCheckOverhead = kLogHeaderSize + kCheckChannel.size();
constexpr size_t kMostBlockCheck = kCheckOverhead + 40 + 4 * kMostCheckedEvents;

// The number of bytes, out of the first `size` in a buffer of events, that belong to events lying whole
// within them.
size_t WholeEvents(const uint8_t* buffer, size_t size) {
  size_t whole = 0;
  while (size - whole >= kLogHeaderSize) {
    const uint8_t* event = buffer + whole;
    const size_t next = whole + kLogHeaderSize + LoadBigEndian32(event + 20) + LoadBigEndian32(event + 24);
    if (next > size) break;
    whole = next;
  }
  return whole;
}
}  // namespace

LogWriter::LogWriter(const std::string& file, Opening opening, std::string note, uint32_t follows,
                     Existing existing)
    : file_(file, opening, existing),
      opening_(opening),
      note_(std::move(note)),
      capacity_(kBufferSize),
      buffer_(std::make_unique_for_overwrite<uint8_t[]>(kBufferSize)),
      previous_(follows) {
  if (note_.size() > kMostCheckText) note_.resize(kMostCheckText);
  checksums_.reserve(4 * kMostCheckedEvents);
}

LogWriter::~LogWriter() {
  if (opening_ == Opening::kTemporary) return;
  try {
    Flush();
  } catch (const WriteError&) {
    // A destructor cannot report errors. A caller that needs them calls Flush() or Finish().
  }
}

void LogWriter::MakeRoom(size_t needed) {
  if (!begun_) needed += kCheckOverhead + CheckDataSize(0, note_.size());
  if (used_ + needed + kMostBlockCheck <= capacity_) return;
  FlushBuffer();
  if (needed + kMostBlockCheck <= capacity_) return;
  buffer_ = std::make_unique_for_overwrite<uint8_t[]>(needed + kMostBlockCheck);
  capacity_ = needed + kMostBlockCheck;
}

uint8_t* LogWriter::Reserve(std::string_view channel, size_t size, int64_t utime) {
  if (channel.empty() || channel.size() > kMaxLogChannelLength || size > kMaxLogDataSize) {
    throw std::invalid_argument("event on channel '" + std::string(channel) + "' with " +
                                std::to_string(size) +
                                " bytes: a channel of 1 to 63 bytes and at most 1 GiB of data are allowed");
  }
  const size_t needed = kLogHeaderSize + channel.size() + size;
  MakeRoom(needed);
  last_utime_ = utime;  // also for the first check: a player waits until the time of the first event
  Begin();
  return WriteHeader(channel, size, utime);
}

uint8_t* LogWriter::WriteHeader(std::string_view channel, size_t size, int64_t utime) {
  uint8_t* event = buffer_.get() + used_;
  StoreBigEndian32(kLogSyncWord, event);
  StoreBigEndian64(static_cast<uint64_t>(events_), event + 4);
  StoreBigEndian64(static_cast<uint64_t>(utime), event + 12);
  StoreBigEndian32(static_cast<uint32_t>(channel.size()), event + 20);
  StoreBigEndian32(static_cast<uint32_t>(size), event + 24);
  std::memcpy(event + kLogHeaderSize, channel.data(), channel.size());
  return event + kLogHeaderSize + channel.size();
}

void LogWriter::Commit(size_t channel_size, size_t size) {
  const size_t written = kLogHeaderSize + channel_size + size;
  const size_t at = checksums_.size();
  checksums_.resize(at + 4);
  StoreBigEndian32(Checksum(buffer_.get() + used_, written), checksums_.data() + at);
  used_ += written;
  bytes_ += static_cast<int64_t>(written);
  ++events_;
  if (checksums_.size() >= 4 * kMostCheckedEvents ||
      bytes_ - checked_bytes_ >= static_cast<int64_t>(kMostCheckedBytes)) {
    AppendCheck(CheckKind::kBlock, {});
  }
}

void LogWriter::AppendCheck(CheckKind kind, std::string_view text) {
  LogCheck check;
  check.kind = kind;
  check.offset = bytes_;
  check.previous = previous_;
  check.count = checksums_.size() / 4;
  check.checksums = checksums_.data();
  check.text = text;
  uint8_t* event = buffer_.get() + used_;
  const size_t size = CheckDataSize(check.count, text.size());
  uint8_t* data = WriteHeader(kCheckChannel, size, last_utime_);
  previous_ = WriteCheckData(check, event, data);
  checksums_.clear();
  used_ += kCheckOverhead + size;
  bytes_ += static_cast<int64_t>(kCheckOverhead + size);
  checked_bytes_ = bytes_;
  begun_ = true;
}

void LogWriter::Append(std::string_view channel, const void* data, size_t size, int64_t utime) {
  if (channel == kCheckChannel) return;
  uint8_t* place = Reserve(channel, size, utime);
  if (size > 0) std::memcpy(place, data, size);
  Commit(channel.size(), size);
}

void LogWriter::Begin() {
  if (!begun_) AppendCheck(CheckKind::kBegin, note_);
}

void LogWriter::Remark(std::string_view text) {
  text = text.substr(0, kMostCheckText);
  MakeRoom(kCheckOverhead + CheckDataSize(0, text.size()));
  Begin();
  AppendCheck(CheckKind::kBlock, text);
}

void LogWriter::Flush() {
  if (!checksums_.empty()) AppendCheck(CheckKind::kBlock, {});
  FlushBuffer();
}

void LogWriter::FlushBuffer() {
  size_t done = 0;
  try {
    while (done < used_) done += file_.WriteSome(buffer_.get() + done, used_ - done);
  } catch (const WriteError&) {
    // Bytes that did reach the file must not be written twice when the caller tries again, and an event of
    // which only a part was written would make the log unreadable.
    const size_t whole = WholeEvents(buffer_.get(), done);
    if (file_.TakeBack(done - whole)) done = whole;
    std::memmove(buffer_.get(), buffer_.get() + done, used_ - done);
    used_ -= done;
    throw;
  }
  used_ = 0;
}

void LogWriter::Finish(std::string_view why) {
  why = why.substr(0, kMostCheckText);
  if (!ended_) {
    MakeRoom(kCheckOverhead + CheckDataSize(0, why.size()));
    Begin();
    AppendCheck(CheckKind::kEnd, why);
    ended_ = true;
  }
  FlushBuffer();
  file_.Finish();
}

}  // namespace hydro::log
