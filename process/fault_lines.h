// Limits how many lines about a fault go to the terminal: a device that comes and goes raises and ends its
// faults hundreds of times a second. The messages (HYDRO_FAULT) have every change.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bus/clock.h"
#include "process/counted_warning.h"

namespace hydro::process {

// Pure: changes and time are passed in. Each fault has lines of its own, so that one which flickers hides no
// other one.
class FaultLines {
 public:
  // So many lines of one fault may come at once; later, one more for each kPeriod that passes.
  static constexpr int kAtOnce = 6;
  static constexpr auto kPeriod = std::chrono::seconds(10);
  // A fault that has not changed for this long stays as it is. It is then soon said how.
  static constexpr auto kQuiet = CountedWarning::kQuiet;

  // A fault of which lines were left out, and how many since its last line.
  struct LeftOut {
    std::string code;
    int64_t lines;
  };

  // Whether the line about a change of this fault is to be shown. If not, it is counted.
  bool Show(const std::string& code, bus::Clock::TimePoint now);

  // Whether the newest change of this fault was not shown.
  bool hides(const std::string& code) const;

  // When TakeDue() next has something to say; TimePoint::max(): while nothing changes, never.
  bus::Clock::TimePoint due() const;

  // The faults of which it must be said now how many lines were left out: once they are quiet, at most once
  // in a kPeriod. `at_end`: all of them. They count as said.
  std::vector<LeftOut> TakeDue(bus::Clock::TimePoint now, bool at_end = false);

 private:
  struct Lines {
    int left = kAtOnce;
    bus::Clock::TimePoint filled{};  // when `left` was last raised
    int64_t hidden = 0;
    bus::Clock::TimePoint hidden_since{}, changed{};
    bus::Clock::TimePoint said = bus::Clock::TimePoint::min();
  };
  static bus::Clock::TimePoint DueOf(const Lines& lines);

  std::map<std::string, Lines> lines_;  // by code
};

}  // namespace hydro::process
