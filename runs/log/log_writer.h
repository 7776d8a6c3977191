// Writes LCM event logs (log_reader.h) with checksums (log_check.h), which lcm-logplayer and lcm_eventlog can
// read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/new_file.h"
#include "runs/log/log_check.h"

namespace hydro::log {

class LogWriter {
 public:
  // Creates `file` (new_file.h). Use Opening::kDirect for a recording in progress, where everything flushed
  // survives a kill, and Opening::kTemporary for a log that appears whole or not at all. Throws InputError
  // when the file cannot be created, also because a log of that name is to be kept. `note` tells readers of
  // the log where it comes from; empty for a recording. `follows` is last_check() of the part before, for a
  // recording in parts; 0: the recording begins here.
  LogWriter(const std::string& file, Opening opening, std::string note = {}, uint32_t follows = 0,
            Existing existing = Existing::kKept);
  // With kDirect, flushes the rest and ignores errors, and the log has no end mark; with kTemporary, removes
  // an unfinished file.
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  // Appends an event to the 1 MiB buffer, which is written when it is full. `utime` is the time of receipt in
  // us since 1970-01-01 UTC, or simulated time. The channel has 1 to 63 bytes, the data at most 1 GiB
  // (std::invalid_argument otherwise). Throws WriteError when the disk is full; the event is then not in the
  // log, and the caller may try the same call again. An event on the channel of the checks (log_check.h) is
  // left out, so that no sender on a bus can claim that a log is whole.
  void Append(std::string_view channel, const void* data, size_t size, int64_t utime);

  // The same for a message, which is encoded in place.
  template <class Message>
  void AppendMessage(std::string_view channel, const Message& message, int64_t utime) {
    if (channel == kCheckChannel) return;
    const int size = message.getEncodedSize();
    if (message.encode(Reserve(channel, static_cast<size_t>(size), utime), 0, size) != size) {
      throw std::invalid_argument("message on " + std::string(channel) + " holds a string with a zero byte");
    }
    Commit(channel.size(), static_cast<size_t>(size));
  }

  // Puts a remark about the recording into the log, where hydro-log info finds it. Throws WriteError.
  void Remark(std::string_view text);

  // Adds a checksum and hands everything to the operating system, after which it survives a kill of this
  // process. Throws WriteError.
  void Flush();

  // Marks the end, flushes, closes and, with kTemporary, gives the file its name. `why` says why the log ends
  // here, if not because it is complete. No events can be appended afterwards.
  void Finish(std::string_view why = {});

  int64_t bytes() const { return bytes_; }  // length of the log, including what is still in the buffer
  // The checksum of the last check event. After Finish() it is that of the end, by which the next part refers
  // to this one.
  uint32_t last_check() const { return previous_; }
  int64_t events() const { return events_; }  // events appended, without the checks
  const std::string& file() const { return file_.name(); }

 private:
  // Makes room in the buffer for one event and a check event after it, and for the first check event if there
  // is none yet.
  void MakeRoom(size_t needed);
  // Appends the first check event if there is none yet.
  void Begin();
  // Makes room for one event, writes its header and channel, and returns the place for its data.
  uint8_t* Reserve(std::string_view channel, size_t size, int64_t utime);
  uint8_t* WriteHeader(std::string_view channel, size_t size, int64_t utime);
  // Counts the event for which Reserve() made room.
  void Commit(size_t channel_size, size_t size);
  // Appends a check event, for which there must be room.
  void AppendCheck(CheckKind kind, std::string_view text);
  void FlushBuffer();

  NewFile file_;
  Opening opening_;
  std::string note_;
  size_t capacity_;
  std::unique_ptr<uint8_t[]> buffer_;
  size_t used_ = 0;
  int64_t bytes_ = 0;
  int64_t events_ = 0;
  int64_t last_utime_ = 0;
  std::vector<uint8_t> checksums_;  // of the events since the last check, for the next
  int64_t checked_bytes_ = 0;       // where the last check ends
  uint32_t previous_ = 0;           // its checksum
  bool begun_ = false;              // the log has its first check event
  bool ended_ = false;              // the log has its last check event
};

}  // namespace hydro::log
