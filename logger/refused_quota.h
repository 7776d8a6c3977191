// Limits how many refused messages (docs/security.md) are recorded: an intruder must not fill the disk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "bus/clock.h"

namespace hydro::logger {

// Admits the first messages of each second, and of the run, up to a number and a size; counts the rest.
class RefusedQuota {
 public:
  static constexpr int64_t kMessagesPerSecond = 1000;
  static constexpr int64_t kBytesPerSecond = 256 << 10;
  static constexpr int64_t kMessages = 20000;
  static constexpr int64_t kBytes = 8 << 20;

  static bool IsRefused(std::string_view channel) { return channel.starts_with("REFUSED_"); }

  // Returns whether a refused message that came at `now` is to be recorded; counts it if not.
  bool Admit(size_t bytes, bus::Clock::TimePoint now);

  int64_t left_out() const { return left_out_; }
  // One line about what was left out; empty when nothing was.
  std::string Text() const;

 private:
  int64_t messages_ = 0, bytes_ = 0;                // recorded so far
  int64_t second_messages_ = 0, second_bytes_ = 0;  // in the second that began at begin_
  bus::Clock::TimePoint begin_{};
  int64_t left_out_ = 0, left_out_bytes_ = 0;
};

}  // namespace hydro::logger
