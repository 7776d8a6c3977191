// Finds where the clock that stamped a log differs from the plant's time: silences, and clocks that were set.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace hydro::runs {

struct ClockStep {
  int64_t event = 0;     // the first event after the step, counted as LogEvent::index
  double at_time_s = 0;  // plant time of the first state after it
  double seconds = 0;    // by which the clock advanced more than plant time; below 0: it was set back
  bool joined =
      false;  // another run with its own plant time begins here; `seconds` is all that the clock advanced
};

// Goes through the events of a log in their order.
class ClockWatch {
 public:
  // `state_time` is the plant time of the newest state, which is this event's if it is a state.
  void Take(int64_t event, int64_t utime, std::optional<double> state_time);

  const std::vector<ClockStep>& steps() const { return steps_; }

 private:
  void Resolve(double state_time);

  std::vector<ClockStep> steps_;
  std::vector<ClockStep> pending_;  // steps whose next state is still to come
  std::optional<int64_t> last_utime_;
  std::optional<double> last_time_;
};

// The total seconds of the steps between two events.
double SecondsOfSteps(const std::vector<ClockStep>& steps, int64_t first_event, int64_t last_event);

}  // namespace hydro::runs
