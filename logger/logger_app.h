// The logger as an application: records every message on the bus.
//
// Messages go from the bus into a queue (event_queue.h); a separate thread writes them to the file, so that a
// slow disk delays nobody. The queue holds up to logger.memory_mb. Messages that find it full are left out of
// the log and counted, and the fault log_overflow is raised. Received messages are handed to the kernel at
// least every kFlushPeriod. Of messages that a bus with a key refuses, a bounded part is recorded
// (refused_quota.h). A log that is deleted while it is recorded is named at once, and ends the logger with 1.
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
#include "logger/event_queue.h"
#include "logger/log_files.h"
#include "logger/refused_quota.h"
#include "process/app.h"
#include "process/participant.h"
#include "settings/stack_config.h"

namespace hydro::logger {

struct LoggerOptions {
  std::string file;
  int64_t rotate_bytes = 0;  // a new file is started when one has grown beyond this; 0: never
};

class LoggerApp : public process::App {
 public:
  static constexpr auto kFlushPeriod = std::chrono::milliseconds(20);

  // Opens the file; throws InputError when it cannot be opened.
  LoggerApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
            const LoggerOptions& options);
  ~LoggerApp() override;

  void Poll() override;
  bool finished() const override;
  int Finish() override;

 private:
  struct Write {
    bus::Clock::TimePoint began;
    bus::Clock::Duration latency;  // since the arrival of the oldest message in it
  };

  bus::Bus& Tap(bus::Bus& bus);
  void Enqueue(std::string_view channel, const uint8_t* data, size_t size, int64_t utime,
               bus::Clock::TimePoint arrived);
  void FollowPlant(int64_t session);
  void CountSequence(const bus::LoopNumbers& numbers);
  void CheckOverflow();
  void OnMessage(const bus::RawMessage& message);
  void OnStatus(const process_status_t& status);
  void WriteUntilClosed();
  Write WriteBatch(const EventQueue::Batch& batch);
  void ReportGone(const std::string& wrong);
  void ReportRefused();
  void ReportProgress();
  bool EveryoneHasLeft() const;
  std::string FailureText();

  bus::Bus& bus_;
  process::Participant participant_;
  LoggerOptions options_;
  const bus::Clock::Duration plant_alive_;  // a plant that is silent for longer may be replaced by another
  LogFiles files_;                          // the writing thread's, once it runs

  std::mutex mutex_;  // guards writes_, closing_, failure_, gone_
  std::condition_variable wake_;
  EventQueue queue_;
  std::vector<Write> writes_;  // completed since the last Poll()
  bool closing_ = false;
  std::exception_ptr failure_;
  std::string gone_;  // what became of a file that is no longer where it was recorded
  std::atomic<bool> failed_ = false;
  std::thread thread_;

  std::optional<bus::Clock::TimePoint> followed_heard_;  // the last state of the plant whose run this is
  RefusedQuota refused_;
  int64_t received_ = 0;
  int64_t largest_queue_ = 0;  // since the last statistics report
  int64_t largest_queue_total_ = 0;
  int64_t state_tick_ = -1;  // newest tick received
  int64_t reported_tick_ = -1;
  bus::Clock::TimePoint report_again_;  // from then on even fewer than kProgressTicks new ticks are reported
  std::optional<log::CausalOrder> order_;  // lockstep: restores the order of the numbered messages
  bool left_ = false;                      // this logger's own DONE or FAILED has come back from the bus
  std::map<int64_t, int8_t> others_;       // the other processes' states, by session
  std::array<std::map<int64_t, int64_t>, bus::kLoopParts> next_sequence_;  // by part and session, for losses
  int64_t lost_ = 0;
  int64_t dropped_ = 0;                             // by the full queue, at the last check
  std::optional<bus::Clock::TimePoint> overflow_;   // during a fault: when the queue last dropped something
  std::optional<bus::Clock::TimePoint> stop_time_;  // when the stop was heard
};

}  // namespace hydro::logger
