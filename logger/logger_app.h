// The logger as an application: records every message on the bus.
//
// Messages go from the bus into a queue (event_queue.h) and from there, on a thread of its own, into the
// file, so that a slow disk delays nobody. The queue takes logger.memory_mb; what comes when it is full is
// left out of the log, counted, and named as the fault log_overflow. What was received is handed to the
// kernel at least every kFlushPeriod.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "log/causal_order.h"
#include "log/log_writer.h"
#include "logger/event_queue.h"
#include "process/app.h"
#include "process/participant.h"
#include "settings/stack_config.h"

namespace hydro::logger {

struct LoggerOptions {
  std::string file;
  int64_t rotate_bytes = 0;  // start a new file when one has grown beyond this; 0: never
};

// Name of the n-th file (n = 0 is `file` itself): run.lcmlog, run-001.lcmlog, run-002.lcmlog ...
std::string RotatedName(const std::string& file, int n);

class LoggerApp : public process::App {
 public:
  static constexpr auto kFlushPeriod = std::chrono::milliseconds(20);

  // Opens the file; throws InputError when that cannot be done.
  LoggerApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
            const LoggerOptions& options);
  ~LoggerApp() override;

  void Poll() override;
  bool finished() const override;
  int Finish() override;

 private:
  struct Write {
    bus::Clock::TimePoint began;
    bus::Clock::Duration latency;  // since the oldest message in it had arrived
  };

  bus::Bus& Tap(bus::Bus& bus);
  void Enqueue(std::string_view channel, const uint8_t* data, size_t size, int64_t utime,
               bus::Clock::TimePoint arrived);
  void CountSequence(log::CausalOrder::Kind kind, const bus::RawMessage& message);
  void CheckOverflow();
  void OnMessage(const bus::RawMessage& message);
  void OnStatus(const process_status_t& status);
  void WriteUntilClosed();
  Write WriteBatch(const EventQueue::Batch& batch);
  void Rotate();
  void ReportProgress();
  bool EveryoneHasLeft() const;
  std::string FailureText();

  bus::Bus& bus_;
  process::Participant participant_;
  LoggerOptions options_;
  std::unique_ptr<log::LogWriter> writer_;  // the writing thread's, once it runs
  int files_ = 1;
  std::map<std::string, log::RecordedMessage>
      descriptions_;  // newest HYDRO_RUN message by channel: opens each rotated file

  std::mutex mutex_;  // guards writes_, closing_, failure_
  std::condition_variable wake_;
  EventQueue queue_;
  std::vector<Write> writes_;  // done since the last Poll()
  bool closing_ = false;
  std::exception_ptr failure_;
  std::atomic<bool> failed_ = false;
  std::thread thread_;

  int64_t received_ = 0;
  int64_t largest_queue_ = 0;  // since the last statistics report
  int64_t largest_queue_total_ = 0;
  int64_t state_tick_ = -1;  // newest tick received
  int64_t reported_tick_ = -1;
  bus::Clock::TimePoint report_again_;     // fewer than kProgressTicks new ticks are reported from then on
  std::optional<log::CausalOrder> order_;  // of the numbered messages, in lockstep
  bool left_ = false;                      // our own farewell has come back
  std::map<int64_t, int8_t> others_;       // state of the other processes, by session
  std::array<std::map<int64_t, int64_t>, 4> next_sequence_;  // by kind and session, to count losses
  int64_t lost_ = 0;
  int64_t dropped_ = 0;                             // by a queue that was full, at the last look
  std::optional<bus::Clock::TimePoint> overflow_;   // when that was seen last, while it is a fault
  std::optional<bus::Clock::TimePoint> stop_time_;  // when the stop was heard
};

}  // namespace hydro::logger
