#include "logger/recording.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "base/new_file.h"

namespace hydro::logger {

std::string RotatedName(const std::string& file, int n) {
  if (n == 0) return file;
  const std::filesystem::path path(file);
  return (path.parent_path() / fmt::format("{}-{:03d}{}", path.stem().string(), n, path.extension().string()))
      .string();
}

LogFiles::LogFiles(const std::string& file, int64_t rotate_bytes, std::string description_channel)
    : file_(Checked(file, rotate_bytes)),
      rotate_bytes_(rotate_bytes),
      description_channel_(std::move(description_channel)),
      writer_(std::make_unique<log::LogWriter>(file_, Opening::kDirect)) {
  watch_.Watch(file_);
}

// Checks all names before the first file is begun: a recording must not end in the middle because of an older
// file.
const std::string& LogFiles::Checked(const std::string& file, int64_t rotate_bytes) {
  namespace fs = std::filesystem;
  if (rotate_bytes <= 0) return file;
  const fs::path path(file);
  const std::string begin = path.stem().string() + "-", end = path.extension().string();
  std::error_code failed;  // LogWriter reports the reason
  for (const auto& entry :
       fs::directory_iterator(path.has_parent_path() ? path.parent_path() : ".", failed)) {
    const std::string name = entry.path().filename();
    if (name.size() <= begin.size() + end.size() || !name.starts_with(begin) || !name.ends_with(end))
      continue;
    const std::string number = name.substr(begin.size(), name.size() - begin.size() - end.size());
    if (number.find_first_not_of("0123456789") == std::string::npos) CheckIsNew(entry.path());
  }
  return file;
}

void LogFiles::Append(const EventQueue::Event& event) {
  if (rotate_bytes_ > 0 && writer_->bytes() >= rotate_bytes_) Rotate();
  writer_->Append(event.channel, event.data, event.size, event.utime);
  if (event.channel == description_channel_) {
    description_ = {description_channel_, {event.data, event.data + event.size}, event.utime};
  }
}

void LogFiles::Rotate() {
  const std::string next = RotatedName(file_, count_++);
  writer_->Finish(std::string(log::kGoesOn) + std::filesystem::path(next).filename().string());
  if (const auto wrong = watch_.LookNow()) gone_ = wrong;
  writer_ = std::make_unique<log::LogWriter>(next, Opening::kDirect, std::string(), writer_->last_check());
  watch_.Watch(next);
  if (!description_) return;
  writer_->Append(description_->channel, description_->data.data(), description_->data.size(),
                  description_->utime);
}

std::optional<std::string> LogFiles::Look(std::chrono::steady_clock::time_point now, bool at_once) {
  if (gone_) return std::exchange(gone_, std::nullopt);
  return at_once ? watch_.LookNow() : watch_.Look(now);
}

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
