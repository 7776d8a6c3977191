// What happened in a run: faults, steps of the reference, stops, gaps. The numbers have no gaps, so that a
// client can tell whether it has all events.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

namespace hydro::scope {

struct Event {
  uint64_t n = 0;
  double t = 0;        // s, plant time
  std::string kind;    // fault, fault_end, step, stop, rearm, tuning, gap, mark, restart
  std::string source;  // role
  std::string code;
  std::string text;
};

class EventList {
 public:
  // A flood of forged events pushes out the oldest, never the newest.
  static constexpr size_t kMost = 20000;

  // Gives the event its number; the first is 1.
  const Event& Add(Event event);

  uint64_t last() const { return last_; }
  uint64_t first() const { return last_ + 1 - events_.size(); }  // the oldest kept
  // The event with number `n` in [first(), last()].
  const Event& At(uint64_t n) const { return events_[n - first()]; }

 private:
  std::deque<Event> events_;
  uint64_t last_ = 0;
};

}  // namespace hydro::scope
