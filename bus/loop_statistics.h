// How a loop keeps time: reported once a second on HYDRO_LOOP_STATISTICS, and summed up over the whole run.
#pragma once

#include <chrono>
#include <cstdint>
#include <hydro/loop_statistics_t.hpp>
#include <optional>
#include <string>

#include "bus/clock.h"
#include "bus/histogram.h"

namespace hydro {

// Pure: time is passed in. Recording takes some ns and allocates nothing.
class LoopStatistics {
 public:
  // `role`, `host` and `session` go into each report; the first interval begins at `start`.
  LoopStatistics(std::string role, std::string host, int64_t session, Clock::TimePoint start);

  // The loop ran: it began at `began`, and `latency` is what loop_statistics_t says of the role. The period
  // is the time since the previous one began.
  void RecordCycle(Clock::TimePoint began, Clock::Duration latency);

  // Counters of the whole run; a report holds what was added since the one before.
  void set_missed_deadlines(int64_t total) { total_missed_ = total; }
  void set_lost_messages(int64_t total) { total_lost_ = total; }
  void AddMissedDeadlines(int64_t count) { total_missed_ += count; }
  void AddLostMessages(int64_t count) { total_lost_ += count; }

  // Messages that are waiting now; a report holds the most since the one before.
  void RecordQueueDepth(int64_t depth);

  // The report that is due, once a second; nothing in between. The sender adds utime.
  std::optional<loop_statistics_t> Poll(Clock::TimePoint now);

  // The same over the whole run so far, whenever it is asked for; marked as whole_run.
  loop_statistics_t Total(Clock::TimePoint now) const;

 private:
  struct Interval {
    Clock::TimePoint start{};
    int64_t cycles = 0;
    Histogram period;   // ns
    Histogram latency;  // ns
    int64_t missed_before = 0;
    int64_t lost_before = 0;
    int64_t queue_depth = 0;
  };

  loop_statistics_t Report(const Interval& interval, Clock::TimePoint now) const;

  std::string role_;
  std::string host_;
  int64_t session_;
  int64_t sequence_ = 0;
  int64_t total_missed_ = 0;
  int64_t total_lost_ = 0;
  std::optional<Clock::TimePoint> previous_began_;
  Interval current_;
  Interval run_;  // the reported intervals together
};

}  // namespace hydro
