#include "logger/logger_app.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <hydro/log_progress_t.hpp>
#include <hydro/motor_command_t.hpp>
#include <hydro/pressure_command_t.hpp>
#include <hydro/state_t.hpp>
#include <utility>

#include "base/integers.h"
#include "process/status.h"

namespace hydro::logger {
namespace {

using namespace std::chrono_literals;

constexpr int64_t kProgressTicks = 16;  // a quarter of plant::LoggerWindow
constexpr int64_t kEndedTicks = 32;     // joints of a limb in lockstep are never so far apart
constexpr auto kEchoTime = 200ms;       // wait for this logger's own last message to come back
constexpr auto kOverflowQuiet = 1s;     // an overflow has ended when nothing was dropped for this long
constexpr auto kFarewellTime = 500ms;   // wait for the others' last messages after a stop

constexpr size_t kMostSenders = 1024;  // senders followed for one kind of message; a flood has more

}  // namespace

LoggerApp::LoggerApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
                     const LoggerOptions& options)
    // First, because subscribing to all channels after other subscriptions could lose messages.
    : bus_(Tap(bus)),
      participant_(bus, clock, bus::Channels(config.bus.channel_suffix), "logger", config.agreed),
      options_(options),
      plant_alive_(bus::FromSeconds(std::max(0.3, 5 / (config.plant.rate_hz * config.time.speed)))),
      recording_({options.file, options.rotate_bytes, static_cast<size_t>(config.logger.memory_mb * 1e6)},
                 participant_.channels().Of<run_description_t>(), clock),
      limb_(!config.joints.empty()),
      lockstep_(config.time.mode == settings::TimeMode::kLockstep),
      progress_ticks_(
          std::max<int64_t>(1, kProgressTicks / std::max<int64_t>(1, std::ssize(config.joints)))) {
  FindStacks(config);
  // A limb's messages come from one process, in order.
  if (config.time.mode == settings::TimeMode::kLockstep && !limb_) {
    order_.emplace(config.pressure_interval_ticks, config.position_interval_ticks,
                   config.plant.command_delay_ticks == 0, [this](const log::RecordedMessage& message) {
                     Enqueue(message.channel, message.data.data(), message.data.size(), message.utime,
                             message.arrived);
                   });
  }
  bus.Subscribe<process_status_t>(participant_.channels().Of<process_status_t>(),
                                  [this](const process_status_t& status) { OnStatus(status); });
  if (limb_) {
    for (const Stack& stack : stacks_) {
      bus.Subscribe<process_status_t>(stack.channels.Of<process_status_t>(),
                                      [this](const process_status_t& status) {
                                        OnStatus(status);
                                        AnswerJoint(status);
                                      });
    }
  }
  if (!options_.disk_is_ready) thread_.emplace(recording_);
  participant_.Announce(process_status_t::READY);
}

void LoggerApp::FindStacks(const settings::StackConfig& config) {
  for (const std::string& suffix : settings::JointSuffixes(config))
    stacks_.push_back({bus::Channels(suffix)});
  for (size_t i = 0; i < stacks_.size(); ++i) {
    bus::ForEachMessage([&]<class Message>(const bus::MessageRow<Message>& row) {
      if (row.part != bus::LoopPart::kNone) stack_of_channel_.emplace(stacks_[i].channels.Of<Message>(), i);
    });
  }
}

LoggerApp::Stack* LoggerApp::StackOf(std::string_view channel) {
  const auto found = stack_of_channel_.find(channel);
  return found == stack_of_channel_.end() ? nullptr : &stacks_[found->second];
}

bus::Bus& LoggerApp::Tap(bus::Bus& bus) {
  bus.SubscribeAll([this](const bus::RawMessage& message) { OnMessage(message); });
  return bus;
}

void LoggerApp::OnMessage(const bus::RawMessage& message) {
  // LCM carries a message without a channel, but no log can hold it; and the check channel belongs to the
  // writer of a log alone.
  if (message.channel.empty() || message.channel == log::kCheckChannel) return;
  if (RefusedQuota::IsRefused(message.channel) &&
      !refused_.Admit(static_cast<size_t>(message.size), participant_.clock().Now())) {
    ReportRefused();
    return;
  }
  ++received_;
  Stack* const stack = StackOf(message.channel);
  std::optional<bus::LoopNumbers> numbers;
  if (stack != nullptr) numbers = bus::ReadLoopNumbers(message, stack->channels);
  if (numbers) CountSequence(*numbers);
  if (numbers && numbers->part == bus::LoopPart::kState) OnState(*stack, *numbers);
  if (order_ && numbers) {
    const auto now = participant_.clock().Now();
    log::RecordedMessage event{std::string(message.channel),
                               {message.data, message.data + message.size},
                               message.receive_utime,
                               now};
    order_->Take(numbers->part, numbers->tick, std::move(event), now);
  } else {
    Enqueue(message.channel, message.data, static_cast<size_t>(message.size), message.receive_utime,
            participant_.clock().Now());
  }
}

// In lockstep a limb waits until the slowest of its joints is recorded; a joint that is far behind has ended.
int64_t LoggerApp::ProgressTick() const {
  int64_t newest = -1;
  for (const Stack& stack : stacks_) newest = std::max(newest, stack.state_tick);
  int64_t slowest = newest;
  for (const Stack& stack : stacks_) {
    if (lockstep_ && newest - stack.state_tick <= kEndedTicks) slowest = std::min(slowest, stack.state_tick);
  }
  return slowest;
}

void LoggerApp::OnState(Stack& stack, const bus::LoopNumbers& numbers) {
  if (!limb_) FollowPlant(numbers.session);  // a limb's joints have sessions of their own
  stack.state_tick = numbers.tick;
  state_tick_ = ProgressTick();
  participant_.set_tick(state_tick_);
  if (participant_.state() == process_status_t::READY) participant_.Announce(process_status_t::RUNNING);
  // A repeated state asks for a repeated answer, which may have been lost.
  const bool again = !limb_ && state_tick_ <= reported_tick_;
  if (state_tick_ >= SaturatingSum(reported_tick_, progress_ticks_) || again) ReportProgress();
}

// The logger records every plant on the bus but takes part in one run: the end of another run is not its own.
void LoggerApp::FollowPlant(int64_t session) {
  const auto now = participant_.clock().Now();
  if (session != participant_.run()) {
    if (followed_heard_ && now - *followed_heard_ <= plant_alive_) return;
    participant_.Follow(session);
  }
  followed_heard_ = now;
}

void LoggerApp::ReportRefused() {
  if (refused_.left_out() == 1) spdlog::warn("{}", refused_.Text());  // once; the total at the end
}

void LoggerApp::CountSequence(const bus::LoopNumbers& numbers) {
  std::map<int64_t, int64_t>& senders = next_sequence_[static_cast<size_t>(numbers.part)];
  if (senders.size() >= kMostSenders && !senders.contains(numbers.session)) return;
  int64_t& next = senders.try_emplace(numbers.session, numbers.sequence).first->second;
  if (numbers.sequence > next) lost_ = SaturatingSum(lost_, SaturatingDifference(numbers.sequence, next));
  if (numbers.sequence >= next) next = SaturatingSum(numbers.sequence, 1);
}

void LoggerApp::Enqueue(std::string_view channel, const uint8_t* data, size_t size, int64_t utime,
                        bus::Clock::TimePoint arrived) {
  largest_queue_ = std::max(largest_queue_, recording_.queue().Push(channel, data, size, utime, arrived));
  largest_queue_total_ = std::max(largest_queue_total_, largest_queue_);
}

// One fault per episode, however much is left out of the log. It never affects the voltage.
void LoggerApp::CheckOverflow() {
  const int64_t dropped = recording_.queue().dropped();
  const auto now = participant_.clock().Now();
  if (dropped > dropped_) {
    dropped_ = dropped;
    overflow_ = now;
    participant_.Raise("log_overflow",
                       fmt::format("{} messages are not in the log so far: the disk is slower than the bus, "
                                   "and {} MB wait (logger.memory_mb)",
                                   dropped, static_cast<double>(recording_.queue().memory()) * 1e-6),
                       static_cast<double>(dropped), 0, false);
  } else if (overflow_ && now - *overflow_ > kOverflowQuiet) {
    overflow_.reset();
    participant_.Clear("log_overflow");
  }
}

void LoggerApp::OnStatus(const process_status_t& status) {
  if (status.role == process::kLaunchRole) return;  // it asks who is present, and never announces its end
  if (status.role != "logger") {
    if (others_.size() >= kMostSenders && !others_.contains(status.session)) return;
    others_[status.session] = process::HasLeft(status);
  } else if (status.session == participant_.session()) {
    left_ = process::HasLeft(status);
  }
}

// A joint's own plant waits for its limb's logger, which it may not have heard yet.
void LoggerApp::AnswerJoint(const process_status_t& status) {
  const bool asks = process::IsPlant(status.role) && status.state == process_status_t::READY;
  if (asks && participant_.state() == process_status_t::RUNNING)
    participant_.Announce(process_status_t::RUNNING);
}

void LoggerApp::ReportProgress() {
  reported_tick_ = state_tick_;
  report_again_ = participant_.clock().Now() + process::kPollPeriod;
  log_progress_t progress;
  progress.utime = participant_.clock().Utime();
  progress.tick = state_tick_;
  progress.session = participant_.session();
  progress.events = received_;
  progress.queue_depth = largest_queue_;
  bus_.Publish(participant_.channels().Of<log_progress_t>(), progress);
}

void LoggerApp::Poll() {
  if (order_ && order_->held_since() &&
      participant_.clock().Now() - *order_->held_since() > WritingThread::kPeriod) {
    order_->Release();  // the message for which the order waits was lost
  }
  CheckOverflow();
  participant_.statistics().set_lost_messages(lost_ + dropped_);
  participant_.statistics().RecordQueueDepth(largest_queue_);
  largest_queue_ = 0;
  if (!thread_) TakeTurn();
  for (const Recording::Write& write : recording_.TakeWrites()) {
    participant_.statistics().RecordCycle(write.began, write.latency);
  }
  participant_.Poll();
  if (state_tick_ > reported_tick_ && participant_.clock().Now() >= report_again_) ReportProgress();
  if (participant_.stop() && !stop_time_) stop_time_ = participant_.clock().Now();
}

// Replaces the writing thread.
void LoggerApp::TakeTurn() {
  const auto now = participant_.clock().Now();
  if (now < next_turn_ || !options_.disk_is_ready()) return;
  next_turn_ = now + WritingThread::kPeriod;
  recording_.WriteWaiting(false);
}

// A signal that no stop has preceded, as when the launcher was killed, reaches all processes at once: the
// ends of the others belong in the log.
void LoggerApp::AwaitFarewells() {
  if (stop_time_) return;
  stop_time_ = participant_.clock().Now();
  while (!finished()) {
    bus_.HandleUntil(participant_.clock().Now() + process::kPollPeriod);
    Poll();
  }
}

int64_t LoggerApp::StillThere() const {
  return std::count_if(others_.begin(), others_.end(), [](const auto& other) { return !other.second; });
}

bool LoggerApp::finished() const {
  if (recording_.failed()) return true;
  return stop_time_ && (StillThere() == 0 || participant_.clock().Now() - *stop_time_ > kFarewellTime);
}

int LoggerApp::Finish() {
  AwaitFarewells();
  int exit_code = participant_.Leave(recording_.FailureText());
  // Handles messages that were sent already, up to this logger's own last message, which comes back from the
  // bus like any other.
  const auto deadline = participant_.clock().Now() + kEchoTime;
  while (!left_ && participant_.clock().Now() < deadline) bus_.HandleUntil(deadline);
  if (order_) order_->Release();
  CloseRecording();
  if (!recording_.Gone().empty()) exit_code = 1;
  TellHowMuch();
  return exit_code;
}

void LoggerApp::CloseRecording() {
  thread_ ? thread_->Close() : recording_.WriteWaiting(true);
  std::vector<std::string> remarks;
  const int64_t left = StillThere();
  if (left > 0) {
    remarks.push_back(
        fmt::format("the end of {} process{} is not in this log: {} not said so within {} ms of the stop",
                    left, left == 1 ? "" : "es", left == 1 ? "it had" : "they had",
                    std::chrono::milliseconds(kFarewellTime).count()));
    spdlog::warn("{}", remarks.back());
  }
  if (const std::string refused = refused_.Text(); !refused.empty()) {
    spdlog::warn("{}", refused);
    remarks.push_back(refused);
  }
  if (const int64_t dropped = recording_.queue().dropped(); dropped > 0) {
    remarks.push_back(
        fmt::format("{} messages are not in the log: the disk was slower than the bus", dropped));
    spdlog::warn("{} (logger.memory_mb)", remarks.back());
  }
  recording_.Finish(remarks);
}

void LoggerApp::TellHowMuch() {
  const std::string size = recording_.files() > 1
                               ? fmt::format("{} and {} more files ({} bytes in the last)", options_.file,
                                             recording_.files() - 1, recording_.bytes())
                               : fmt::format("{} ({} bytes)", options_.file, recording_.bytes());
  spdlog::info("{} messages in {}; at most {} waited for the disk; {} lost before they arrived",
               received_ - recording_.queue().dropped(), size, largest_queue_total_, lost_);
}

}  // namespace hydro::logger
