// Where the clock that stamped a log did not go as the plant's time did: silences, and clocks that were set.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace hydro::runs {

struct ClockStep {
  int64_t event = 0;     // the first after it, counted as LogEvent::index
  double at_time_s = 0;  // plant time of the first state after it
  double seconds = 0;    // by which the clock went on further than plant time; below 0: it was set back
  bool joined =
      false;  // another run begins there, with a plant time of its own: all that the clock went on by
};

// Goes through the events of a log in their order.
class ClockWatch {
 public:
  // `state_time`: the plant time of the newest state, this event's if it is one.
  void Take(int64_t event, int64_t utime, std::optional<double> state_time);

  const std::vector<ClockStep>& steps() const { return steps_; }

 private:
  void Resolve(double state_time);

  std::vector<ClockStep> steps_;
  std::vector<ClockStep> pending_;  // of which the next state is still to come
  std::optional<int64_t> last_utime_;
  std::optional<double> last_time_;
};

// The seconds of those between two events.
double SecondsOfSteps(const std::vector<ClockStep>& steps, int64_t first_event, int64_t last_event);

}  // namespace hydro::runs
