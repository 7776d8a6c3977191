// Measures how long a state waits for its answer, on the clock of the process that sends the states.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "bus/clock.h"

namespace hydro::timing {

// Pure: time is passed in. Remembers the last kRemembered ticks; an answer to an older one is not measured.
class RoundTripMonitor {
 public:
  static constexpr int64_t kRemembered = 1024;

  // Records that the state of `tick` was sent at `now`. A state that is sent again counts from the first
  // time.
  void OnSent(int64_t tick, bus::Clock::TimePoint now) {
    Sent& sent = sent_[Index(tick)];
    if (sent.tick != tick) sent = {tick, now, false};
  }

  // The time that the first answer to `tick` took; nothing for a later answer, or for a tick that was not
  // sent.
  std::optional<bus::Clock::Duration> OnAnswer(int64_t tick, bus::Clock::TimePoint now) {
    Sent& sent = sent_[Index(tick)];
    if (sent.tick != tick || sent.answered) return std::nullopt;
    sent.answered = true;
    return now - sent.time;
  }

 private:
  struct Sent {
    int64_t tick = -1;
    bus::Clock::TimePoint time{};
    bool answered = true;  // nothing was sent yet
  };
  static size_t Index(int64_t tick) { return static_cast<uint64_t>(tick) % kRemembered; }

  std::array<Sent, kRemembered> sent_{};
};

}  // namespace hydro::timing
