// A warning about something that is counted, such as messages that cannot be decoded: one fault per episode,
// however high the count goes.
#pragma once

#include <cstdint>
#include <string>

#include "bus/clock.h"

namespace hydro::process {

class CountedWarning {
 public:
  // An episode ends when the count has not grown for this long.
  static constexpr auto kQuiet = std::chrono::seconds(1);

  explicit CountedWarning(std::string code) : code_(std::move(code)) {}

  // Call it often with the count so far. When the count has grown, it raises a fault on `faults` with the
  // text `describe(count)`; the fault never affects the voltage. Cheap while nothing is counted.
  template <class Describe, class Faults>
  void Update(int64_t count, bus::Clock::TimePoint now, Describe&& describe, Faults& faults) {
    if (IsQuiet(count)) return;
    if (count != count_) {
      count_ = count;
      grew_ = now;
      if (active_) return;
      active_ = true;
      faults.Raise(code_, describe(count), static_cast<double>(count), 0, false);
    } else if (now - grew_ > kQuiet) {
      active_ = false;
      // The first message of a flood began the episode; its end reports how many there were.
      faults.Clear(code_, describe(count_), static_cast<double>(count_));
    }
  }

  // Whether Update() with that count would do nothing.
  bool IsQuiet(int64_t count) const { return count == count_ && !active_; }

  // Whether an episode lasts; only then does the passing of time alone change something.
  bool active() const { return active_; }

 private:
  const std::string code_;
  int64_t count_ = 0;
  bool active_ = false;
  bus::Clock::TimePoint grew_{};
};

}  // namespace hydro::process
