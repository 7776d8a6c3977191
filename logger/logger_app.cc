#include "logger/logger_app.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <hydro/log_progress_t.hpp>
#include <hydro/motor_command_t.hpp>
#include <hydro/pressure_command_t.hpp>
#include <hydro/state_t.hpp>
#include <utility>

namespace hydro {
namespace {

using namespace std::chrono_literals;

constexpr int64_t kProgressTicks = 16;  // a quarter of the plant's window (plant_app.cc)
constexpr auto kEchoTime = 200ms;       // how long to wait for our own last words to come back
constexpr auto kFarewellTime = 500ms;   // how long to wait for the others' last words after a stop

// Fields common to the numbered messages, read without decoding the rest: after the 8 bytes of the type's
// hash come utime, tick, session and sequence, 8 bytes each, big-endian (LCM's encoding).
int64_t ReadInt64(const uint8_t* data) {
  uint64_t value = 0;
  for (int i = 0; i < 8; ++i) value = value << 8 | data[i];
  return static_cast<int64_t>(value);
}
constexpr int kTickOffset = 16;
constexpr int kSessionOffset = 24;
constexpr int kSequenceOffset = 32;

}  // namespace

std::string RotatedName(const std::string& file, int n) {
  if (n == 0) return file;
  const std::filesystem::path path(file);
  return (path.parent_path() / fmt::format("{}-{:03d}{}", path.stem().string(), n, path.extension().string()))
      .string();
}

LoggerApp::LoggerApp(Bus& bus, Clock& clock, const StackConfig& config, const LoggerOptions& options)
    : bus_(Tap(bus)),  // first of all: a subscription to all channels beside earlier ones could lose messages
      participant_(bus, clock, Channels(config.bus.channel_suffix), "logger"),
      options_(options),
      writer_(std::make_unique<LogWriter>(options.file, Opening::kDirect)),
      lockstep_(config.time.mode == TimeMode::kLockstep),
      pressure_interval_(config.pressure_interval_ticks),
      position_interval_(config.position_interval_ticks) {
  bus.Subscribe<process_status_t>(participant_.channels().process_status,
                                  [this](const process_status_t& status) { OnStatus(status); });
  thread_ = std::thread([this] { WriteUntilClosed(); });
  participant_.Announce(process_status_t::READY);
}

Bus& LoggerApp::Tap(Bus& bus) {
  bus.SubscribeAll([this](const RawMessage& message) { OnMessage(message); });
  return bus;
}

LoggerApp::~LoggerApp() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void LoggerApp::OnMessage(const RawMessage& message) {
  if (message.channel.empty()) return;  // LCM carries such a message, but no log can hold it
  Event event{
      std::string(message.channel), {message.data, message.data + message.size}, message.receive_utime};
  ++received_;
  const Channels& channels = participant_.channels();
  const bool numbered = message.channel == channels.state || message.channel == channels.motor_command ||
                        message.channel == channels.pressure_command ||
                        message.channel == channels.arm_reference;
  if (numbered && message.size >= kSequenceOffset + 8) {
    const int64_t sequence = ReadInt64(message.data + kSequenceOffset);
    int64_t& next = next_sequence_[event.channel]
                        .try_emplace(ReadInt64(message.data + kSessionOffset), sequence)
                        .first->second;
    if (sequence > next) lost_ += sequence - next;
    if (sequence >= next) next = sequence + 1;
  }
  if (message.channel == channels.state && message.size >= kSequenceOffset) {
    state_tick_ = ReadInt64(message.data + kTickOffset);
    participant_.set_tick(state_tick_);
    if (participant_.state() == process_status_t::READY) participant_.Announce(process_status_t::RUNNING);
    // A state that is sent again asks for the answer again; it may have been lost.
    if (state_tick_ >= reported_tick_ + kProgressTicks || state_tick_ <= reported_tick_) ReportProgress();
  }
  // The kernel delivers a datagram to one socket after the other: the plant may have an answer, and its next
  // state may be here, before that answer is. In lockstep the order of cause and effect is known, and the log
  // keeps it.
  if (numbered && message.size >= kSequenceOffset) {
    const int64_t tick = ReadInt64(message.data + kTickOffset);
    if (message.channel == channels.state) {
      if (held_) ReleaseHeld();
      if (lockstep_ && !AnswersAreIn(tick - 1)) {
        held_ = std::move(event);
        held_tick_ = tick;
        held_since_ = participant_.clock().Now();
        return;
      }
    } else if (message.channel == channels.motor_command) {
      motor_command_tick_ = tick;
    } else if (message.channel == channels.pressure_command) {
      pressure_command_tick_ = tick;
    }
    if (message.channel == channels.state) {
      held_ = std::move(event);
      held_tick_ = tick;
      ReleaseHeld();
      return;
    }
    if (lockstep_ && tick > queued_state_tick_) {
      if (early_.empty() && !held_) held_since_ = participant_.clock().Now();
      early_.push_back(std::move(event));
      return;
    }
  }
  Enqueue(std::move(event));
  if (held_ && AnswersAreIn(held_tick_ - 1)) ReleaseHeld();
}

bool LoggerApp::AnswersAreIn(int64_t tick) const {
  return (tick < 0 || tick % pressure_interval_ != 0 || motor_command_tick_ >= tick) &&
         (tick < 0 || tick % position_interval_ != 0 || pressure_command_tick_ >= tick);
}

void LoggerApp::ReleaseHeld() {
  if (held_) {
    Event event = std::move(*held_);
    held_.reset();
    queued_state_tick_ = held_tick_;
    Enqueue(std::move(event));
  }
  for (Event& event : early_) Enqueue(std::move(event));
  early_.clear();
}

void LoggerApp::Enqueue(Event event) {
  size_t waiting = 0;
  {
    const std::lock_guard lock(mutex_);
    queue_.push_back(std::move(event));
    waiting = queue_.size();
  }
  largest_queue_ = std::max(largest_queue_, static_cast<int64_t>(waiting));
  largest_queue_total_ = std::max(largest_queue_total_, largest_queue_);
}

void LoggerApp::OnStatus(const process_status_t& status) {
  if (status.role != "logger") {
    others_[status.session] = status.state;
  } else if (status.session == participant_.session()) {
    left_ = status.state == process_status_t::DONE || status.state == process_status_t::FAILED;
  }
}

void LoggerApp::ReportProgress() {
  reported_tick_ = state_tick_;
  report_again_ = participant_.clock().Now() + kPollPeriod;
  log_progress_t progress;
  progress.utime = participant_.clock().Utime();
  progress.tick = state_tick_;
  progress.session = participant_.session();
  progress.events = received_;
  progress.queue_depth = largest_queue_;
  bus_.Publish(participant_.channels().log_progress, progress);
}

// Wakes by itself every kFlushPeriod: a notification per message would cost the receiving thread a system
// call each.
void LoggerApp::WriteUntilClosed() {
  try {
    for (bool closing = false; !closing;) {
      std::deque<Event> batch;
      {
        std::unique_lock lock(mutex_);
        wake_.wait_for(lock, kFlushPeriod, [this] { return closing_; });
        batch.swap(queue_);
        closing = closing_;
      }
      if (batch.empty()) continue;
      const Write write = WriteBatch(batch);
      const std::lock_guard lock(mutex_);
      writes_.push_back(write);
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    failed_ = true;
  }
}

LoggerApp::Write LoggerApp::WriteBatch(std::deque<Event>& batch) {
  const auto began = participant_.clock().Now();
  const int64_t oldest_utime = batch.front().utime;
  for (Event& event : batch) {
    if (options_.rotate_bytes > 0 && writer_->bytes() >= options_.rotate_bytes) Rotate();
    writer_->Append(event.channel, event.data.data(), event.data.size(), event.utime);
    if (event.channel == participant_.channels().run) descriptions_[event.channel] = std::move(event);
  }
  writer_->Flush();
  return {began, std::chrono::microseconds(participant_.clock().Utime() - oldest_utime)};
}

void LoggerApp::Rotate() {
  writer_->Finish();
  writer_ = std::make_unique<LogWriter>(RotatedName(options_.file, files_++), Opening::kDirect);
  for (const auto& [channel, event] : descriptions_) {
    writer_->Append(channel, event.data.data(), event.data.size(), event.utime);
  }
}

void LoggerApp::Poll() {
  if ((held_ || !early_.empty()) && participant_.clock().Now() - held_since_ > kFlushPeriod)
    ReleaseHeld();  // the answer was lost
  participant_.statistics().set_lost_messages(lost_);
  participant_.statistics().RecordQueueDepth(largest_queue_);
  largest_queue_ = 0;
  {
    const std::lock_guard lock(mutex_);
    for (const Write& write : writes_) participant_.statistics().RecordCycle(write.began, write.latency);
    writes_.clear();
  }
  participant_.Poll();
  if (state_tick_ > reported_tick_ && participant_.clock().Now() >= report_again_) ReportProgress();
  if (participant_.stop() && !stop_time_) stop_time_ = participant_.clock().Now();
}

bool LoggerApp::EveryoneHasLeft() const {
  for (const auto& [session, state] : others_) {
    if (state != process_status_t::DONE && state != process_status_t::FAILED) return false;
  }
  return true;
}

bool LoggerApp::finished() const {
  if (failed_) return true;
  return stop_time_ && (EveryoneHasLeft() || participant_.clock().Now() - *stop_time_ > kFarewellTime);
}

int LoggerApp::Finish() {
  int exit_code = participant_.Leave();
  // What has been sent already, up to our own farewell, which comes back to us as everybody's.
  const auto deadline = participant_.clock().Now() + kEchoTime;
  while (!left_ && participant_.clock().Now() < deadline) bus_.HandleUntil(deadline);
  ReleaseHeld();
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  wake_.notify_one();
  thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  writer_->Finish();
  spdlog::info("{} messages in {}{}, {} bytes in the last; at most {} waited; {} lost before they arrived",
               received_, options_.file, files_ > 1 ? fmt::format(" and {} more files", files_ - 1) : "",
               writer_->bytes(), largest_queue_total_, lost_);
  return exit_code;
}

}  // namespace hydro
