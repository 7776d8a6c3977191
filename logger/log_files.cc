#include "logger/log_files.h"

#include <spdlog/fmt/fmt.h>

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

}  // namespace hydro::logger
