// Writes LCM event logs (log_format.h): lcm-logplayer and lcm_eventlog read them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/new_file.h"

namespace hydro::log {

class LogWriter {
 public:
  // Creates `file` (new_file.h): Opening::kDirect for a recording in progress, where everything flushed
  // survives a kill; Opening::kTemporary for a log that appears whole or not at all. Throws InputError when
  // it cannot be created.
  LogWriter(const std::string& file, Opening opening);
  // With kDirect, flushes the rest and ignores errors; with kTemporary, removes an unfinished file.
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  // Appends an event to the 1 MiB buffer, which is written when full. `utime`: us since 1970-01-01 UTC, or
  // simulated time, at receipt. The channel has 1 to 63 bytes, the data at most 1 GiB (std::invalid_argument
  // otherwise). Throws WriteError when the disk is full; the event is then not in the log, and the caller may
  // try the same call again.
  void Append(std::string_view channel, const void* data, size_t size, int64_t utime);

  // The same for a message, encoded in place.
  template <class Message>
  void AppendMessage(std::string_view channel, const Message& message, int64_t utime) {
    const int size = message.getEncodedSize();
    if (message.encode(Reserve(channel, static_cast<size_t>(size), utime), 0, size) != size) {
      throw std::invalid_argument("message on " + std::string(channel) + " holds a string with a zero byte");
    }
    Commit(channel.size(), static_cast<size_t>(size));
  }

  // Hands everything to the operating system, after which it survives a kill of this process. Throws
  // WriteError.
  void Flush();

  // Flushes, closes and, with kTemporary, gives the file its name. No events can be appended afterwards.
  void Finish();

  int64_t bytes() const { return bytes_; }    // length of the log, including what is still in the buffer
  int64_t events() const { return events_; }  // events appended
  const std::string& file() const { return file_.name(); }

 private:
  // Makes room in the buffer for one event, writes its header and channel, and returns the place for its
  // data.
  uint8_t* Reserve(std::string_view channel, size_t size, int64_t utime);
  // Counts the event that Reserve() made room for.
  void Commit(size_t channel_size, size_t size);

  NewFile file_;
  Opening opening_;
  size_t capacity_;
  std::unique_ptr<uint8_t[]> buffer_;
  size_t used_ = 0;
  int64_t bytes_ = 0;
  int64_t events_ = 0;
};

}  // namespace hydro::log
