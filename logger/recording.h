// The writing half of a logger: its files, and the thread that fills them.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/file_watch.h"
#include "bus/clock.h"
#include "logger/event_queue.h"
#include "runs/log/causal_order.h"
#include "runs/log/log_writer.h"

namespace hydro::logger {

// The name of the n-th file (n = 0 is `file` itself): run.lcmlog, run-001.lcmlog, run-002.lcmlog ...
std::string RotatedName(const std::string& file, int n);

// The files of a recording: one file or, when the size is limited, several in succession.
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

struct RecordingOptions {
  std::string file;
  int64_t rotate_bytes = 0;  // a new file is started when one has grown beyond this; 0: never
  size_t memory = 0;         // bytes, of the queue
};

class Recording {
 public:
  struct Write {
    bus::Clock::TimePoint began;
    bus::Clock::Duration latency;  // since the arrival of the oldest message in the write
  };

  // Opens the file; throws InputError when it cannot be opened. `description_channel`: LogFiles.
  Recording(const RecordingOptions& options, const std::string& description_channel, const bus::Clock& clock);

  EventQueue& queue() { return queue_; }

  // Takes one turn: writes the messages that wait, and checks the file, in the `last` turn without delay. An
  // error is kept for failed() and Finish(), and nothing more is written then.
  void WriteWaiting(bool last);

  // Called after the last turn: writes remarks on what was left out, and ends the log. Throws what a turn
  // threw.
  void Finish(const std::vector<std::string>& remarks);

  // Any thread may call these while another writes:
  std::vector<Write> TakeWrites();  // those completed since the last call
  bool failed() const { return failed_; }
  std::string FailureText();  // why writing failed, or what became of the file; empty while all is well
  std::string Gone();         // what became of a file that is no longer where it was recorded

  // Only the writing thread may call these, or any thread after it has ended:
  int files() const { return files_.count(); }
  int64_t bytes() const { return files_.bytes(); }  // of the present file

 private:
  Write WriteBatch(const EventQueue::Batch& batch);
  void ReportGone(const std::string& wrong);

  const bus::Clock& clock_;
  LogFiles files_;
  EventQueue queue_;
  std::mutex mutex_;  // guards writes_, failure_, gone_
  std::vector<Write> writes_;
  std::exception_ptr failure_;
  std::string gone_;
  std::atomic<bool> failed_ = false;
};

// Takes turns for a recording, one each kPeriod: a notification per message would cost the receiving thread a
// system call each.
class WritingThread {
 public:
  static constexpr auto kPeriod = std::chrono::milliseconds(20);

  explicit WritingThread(Recording& recording);
  ~WritingThread() { Close(); }

  // Takes the last turn and ends. Later calls do nothing.
  void Close();

 private:
  void Run();

  Recording& recording_;
  std::mutex mutex_;  // guards closing_
  std::condition_variable wake_;
  bool closing_ = false;
  std::thread thread_;
};

}  // namespace hydro::logger
