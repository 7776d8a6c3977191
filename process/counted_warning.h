// A warning about something that is counted, such as messages that nobody can read: one fault an episode,
// however many there are.
#pragma once

#include <cstdint>
#include <string>

#include "bus/clock.h"

namespace hydro::process {

class CountedWarning {
 public:
  // An episode ends when the count has not grown for so long.
  static constexpr auto kQuiet = std::chrono::seconds(1);

  explicit CountedWarning(std::string code) : code_(std::move(code)) {}

  // To be called often with the count so far. Where it has grown it raises the fault at `faults`, whose text
  // is `describe(count)`; it never zeroes a voltage. Cheap while nothing is counted.
  template <class Describe, class Faults>
  void Update(int64_t count, bus::Clock::TimePoint now, Describe&& describe, Faults& faults) {
    if (count == count_ && !active_) return;
    if (count != count_) {
      count_ = count;
      grew_ = now;
      if (active_) return;
      active_ = true;
      faults.Raise(code_, describe(count), static_cast<double>(count), 0, false);
    } else if (now - grew_ > kQuiet) {
      active_ = false;
      faults.Clear(code_);
    }
  }

 private:
  const std::string code_;
  int64_t count_ = 0;
  bool active_ = false;
  bus::Clock::TimePoint grew_{};
};

}  // namespace hydro::process
