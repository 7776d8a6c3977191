// What happened in a run: faults, steps of the reference, stops, gaps. Numbered without gaps, so that a client knows that it
// has all.
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
  // A flood of made-up ones pushes out the oldest, never the newest.
  static constexpr size_t kMost = 20000;

  // Gives the event its number, from 1.
  const Event& Add(Event event);

  uint64_t last() const { return last_; }
  uint64_t first() const { return last_ + 1 - events_.size(); }  // the oldest kept
  // One of [first(), last()].
  const Event& At(uint64_t n) const { return events_[n - first()]; }

 private:
  std::deque<Event> events_;
  uint64_t last_ = 0;
};

}  // namespace hydro::scope
