// The plant time at which a message of a log belongs.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "hydro/state_t.hpp"

namespace hydro::exports {

// Plant time by tick. A log may hold several plants one after another, each with its own ticks. A message
// belongs to the plant whose state came last.
class RowTimes {
 public:
  // Takes the states, in the order of the log.
  void Add(const state_t& state);

  // What a row keeps until all states are known. This is needed because a command may be recorded before the
  // state that it answers.
  struct Mark {
    size_t plant = 0;
    std::optional<int64_t> tick;
    double latest = 0;  // s, time of the last state before the message; NaN: none
  };
  Mark Here(std::optional<int64_t> tick) const;

  // The time of the tick's state or, without a tick or where the log lacks that state, the time of the last
  // state before the message. Call it after the last Add().
  double At(const Mark& mark);

 private:
  struct Plant {
    int64_t session = 0;
    std::vector<std::pair<int64_t, double>> ticks;  // tick, s
    bool sorted = false;
  };
  std::vector<Plant> plants_;
  double latest_ = 0;
};

}  // namespace hydro::exports
