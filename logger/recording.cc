#include "logger/recording.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace hydro::logger {

Recording::Recording(const RecordingOptions& options, const std::string& description_channel,
                     const bus::Clock& clock)
    : clock_(clock),
      files_(options.file, options.rotate_bytes, description_channel),
      queue_(options.memory) {}

void Recording::WriteWaiting(bool last) {
  if (failed_) return;
  try {
    if (const auto wrong = files_.Look(clock_.Now(), last)) ReportGone(*wrong);
    const EventQueue::Batch batch = queue_.Take();
    if (batch.empty()) return;
    const Write write = WriteBatch(batch);
    const std::lock_guard lock(mutex_);
    writes_.push_back(write);
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    failed_ = true;
  }
}

Recording::Write Recording::WriteBatch(const EventQueue::Batch& batch) {
  const auto began = clock_.Now();
  std::optional<bus::Clock::TimePoint> oldest;
  batch.ForEach([&](const EventQueue::Event& event) {
    if (!oldest) oldest = event.arrived;
    files_.Append(event);
  });
  files_.Flush();
  const auto now = clock_.Now();
  return {began, now - oldest.value_or(now)};
}

// Recording goes on: an open file still takes what is written, and may be copied from /proc.
void Recording::ReportGone(const std::string& wrong) {
  spdlog::error("{}; recording goes on, and this logger will end with 1", wrong);
  const std::lock_guard lock(mutex_);
  if (gone_.empty()) gone_ = wrong;
}

std::vector<Recording::Write> Recording::TakeWrites() {
  const std::lock_guard lock(mutex_);
  return std::exchange(writes_, {});
}

std::string Recording::FailureText() {
  const std::lock_guard lock(mutex_);
  if (!failure_) return gone_;
  try {
    std::rethrow_exception(failure_);
  } catch (const std::exception& error) {
    return error.what();
  }
}

std::string Recording::Gone() {
  const std::lock_guard lock(mutex_);
  return gone_;
}

void Recording::Finish(const std::vector<std::string>& remarks) {
  if (failure_) std::rethrow_exception(failure_);
  for (const std::string& remark : remarks) files_.Remark(remark);
  files_.Finish();
}

WritingThread::WritingThread(Recording& recording) : recording_(recording), thread_([this] { Run(); }) {}

void WritingThread::Run() {
  for (bool closing = false; !closing;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, kPeriod, [this] { return closing_; });
      closing = closing_;
    }
    recording_.WriteWaiting(closing);
  }
}

void WritingThread::Close() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

}  // namespace hydro::logger
