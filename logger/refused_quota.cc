#include "logger/refused_quota.h"

#include <spdlog/fmt/fmt.h>

namespace hydro::logger {

bool RefusedQuota::Admit(size_t bytes, bus::Clock::TimePoint now) {
  const auto size = static_cast<int64_t>(bytes);
  if (now - begin_ >= std::chrono::seconds(1)) {
    begin_ = now;
    second_messages_ = second_bytes_ = 0;
  }
  if (second_messages_ >= kMessagesPerSecond || second_bytes_ + size > kBytesPerSecond ||
      messages_ >= kMessages || bytes_ + size > kBytes) {
    ++left_out_;
    left_out_bytes_ += size;
    return false;
  }
  ++messages_;
  ++second_messages_;
  bytes_ += size;
  second_bytes_ += size;
  return true;
}

std::string RefusedQuota::Text() const {
  if (left_out_ == 0) return {};
  return fmt::format(
      "{} refused messages ({} bytes) were left out: at most {} and {} KiB a second are recorded, {} and {} "
      "MiB "
      "in a run",
      left_out_, left_out_bytes_, kMessagesPerSecond, kBytesPerSecond >> 10, kMessages, kBytes >> 20);
}

}  // namespace hydro::logger
