// The files of a recording: one file or, when the size is limited, several in succession.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/file_watch.h"
#include "logger/event_queue.h"
#include "runs/log/causal_order.h"
#include "runs/log/log_writer.h"

namespace hydro::logger {

// The name of the n-th file (n = 0 is `file` itself): run.lcmlog, run-001.lcmlog, run-002.lcmlog ...
std::string RotatedName(const std::string& file, int n);

class LogFiles {
 public:
  // Opens the first file; throws InputError when it cannot be opened, or when later files of such a recording
  // exist already and must be kept (new_file.h). When a file has grown beyond `rotate_bytes`, a new one is
  // started; 0: never. Each file begins with the newest message of `description_channel`, so that it
  // describes itself.
  LogFiles(const std::string& file, int64_t rotate_bytes, std::string description_channel);

  // These throw WriteError, and InputError when a further file cannot be opened.
  void Append(const EventQueue::Event& event);
  void Flush() { writer_->Flush(); }
  // End the recording, with remarks for the log on what was left out.
  void Remark(std::string_view text) { writer_->Remark(text); }
  void Finish() { writer_->Finish(); }

  // Checks whether the present file is still where it was opened: once a second, or now with `at_once`.
  // Returns what is wrong, once for each file (file_watch.h).
  std::optional<std::string> Look(std::chrono::steady_clock::time_point now, bool at_once);

  int count() const { return count_; }
  int64_t bytes() const { return writer_->bytes(); }  // of the present file

 private:
  void Rotate();
  static const std::string& Checked(const std::string& file, int64_t rotate_bytes);

  std::string file_;
  int64_t rotate_bytes_;
  std::string description_channel_;
  std::unique_ptr<log::LogWriter> writer_;
  FileWatch watch_;
  std::optional<std::string> gone_;  // what became of a file that was left behind
  int count_ = 1;
  std::optional<log::RecordedMessage> description_;
};

}  // namespace hydro::logger
