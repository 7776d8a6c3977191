// The logger as an application: records every message on the bus.
//
// Messages go from the bus into a queue (event_queue.h); a separate thread writes them to the file
// (recording.h), so that a slow disk delays no process. The queue holds up to logger.memory_mb. Messages that
// find it full are left out of the log and counted, and the fault log_overflow is raised. Received messages
// are handed to the kernel at least every WritingThread::kPeriod. Of the messages that a bus with a key
// refuses, a bounded part is recorded (event_queue.h). If the log is deleted while it is recorded, the
// logger reports that at once and ends with exit code 1.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "logger/event_queue.h"
#include "logger/recording.h"
#include "process/app.h"
#include "process/participant.h"
#include "runs/log/causal_order.h"
#include "settings/stack_config.h"

namespace hydro::logger {

struct LoggerOptions {
  std::string file;
  int64_t rotate_bytes = 0;  // a new file is started when one has grown beyond this; 0: never
  // For a simulator, which has no second thread: whether the disk takes the waiting data now. None: a thread
  // of its own writes.
  std::function<bool()> disk_is_ready = {};
};

class LoggerApp : public process::App {
 public:
  // Opens the file; throws InputError when it cannot be opened.
  LoggerApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
            const LoggerOptions& options);

  void Poll() override;
  bool finished() const override;
  int Finish() override;

 private:
  // What the logger knows of a stack, or of a joint's stack.
  struct Stack {
    bus::Channels channels;
    int64_t state_tick = -1;  // newest received
  };

  bus::Bus& Tap(bus::Bus& bus);
  void FindStacks(const settings::StackConfig& config);
  Stack* StackOf(std::string_view channel);
  void OnState(Stack& stack, const bus::LoopNumbers& numbers);
  int64_t ProgressTick() const;
  void Enqueue(std::string_view channel, const uint8_t* data, size_t size, int64_t utime,
               bus::Clock::TimePoint arrived);
  void FollowPlant(int64_t session);
  void CountSequence(const bus::LoopNumbers& numbers);
  void CheckOverflow();
  void OnMessage(const bus::RawMessage& message);
  void OnStatus(const process_status_t& status);
  void AnswerJoint(const process_status_t& status);
  void ReportRefused();
  void ReportProgress();
  void AwaitFarewells();
  int64_t StillThere() const;
  void TakeTurn();
  void CloseRecording();
  void TellHowMuch();

  bus::Bus& bus_;
  process::Participant participant_;
  LoggerOptions options_;
  const bus::Clock::Duration plant_alive_;  // a plant that is silent for longer may be replaced by another
  Recording recording_;
  std::optional<WritingThread> thread_;
  bus::Clock::TimePoint next_turn_;  // without a thread

  // The time of the last state of the plant whose run this is.
  std::optional<bus::Clock::TimePoint> followed_heard_;
  RefusedQuota refused_;
  int64_t received_ = 0;
  int64_t largest_queue_ = 0;  // since the last statistics report
  int64_t largest_queue_total_ = 0;
  std::vector<Stack> stacks_;                                      // one, or a limb's joints
  std::unordered_map<std::string_view, size_t> stack_of_channel_;  // of the loops
  const bool limb_;
  const bool lockstep_;
  const int64_t progress_ticks_;
  int64_t state_tick_ = -1;  // newest tick received of every stack
  int64_t reported_tick_ = -1;
  bus::Clock::TimePoint report_again_;  // from then on, fewer than kProgressTicks new ticks are also reported
  std::optional<log::CausalOrder> order_;  // lockstep: restores the order of the numbered messages
  bool left_ = false;                      // this logger's own DONE or FAILED has come back from the bus
  std::map<int64_t, bool> others_;         // whether each other process has left, by session
  // By part and session, to count losses.
  std::array<std::map<int64_t, int64_t>, bus::kLoopParts> next_sequence_;
  int64_t lost_ = 0;
  int64_t dropped_ = 0;                             // by the full queue, as of the last check
  std::optional<bus::Clock::TimePoint> overflow_;   // during a fault: when the queue last dropped something
  std::optional<bus::Clock::TimePoint> stop_time_;  // when the stop was heard
};

}  // namespace hydro::logger
