// The writing half of a logger: writes the messages that wait in its queue to the files, turn by turn.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "bus/clock.h"
#include "logger/event_queue.h"
#include "logger/log_files.h"

namespace hydro::logger {

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

  // Opens the file; throws InputError when it cannot be opened. `description_channel`: log_files.h.
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
