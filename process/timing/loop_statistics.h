// Measures how well a loop keeps time. It reports once a second on HYDRO_LOOP_STATISTICS, summarises the
// whole run, and gives histograms on HYDRO_LOOP_HISTOGRAM.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <hydro/loop_histogram_t.hpp>
#include <hydro/loop_statistics_t.hpp>
#include <optional>
#include <string>

#include "base/integers.h"
#include "bus/clock.h"
#include "process/timing/histogram.h"

namespace hydro::timing {

// The quantities that have a histogram; loop_histogram_t explains each.
enum class LoopQuantity { kPeriod, kLatency, kRoundTrip, kQueueDepth, kGap, kSkipped };
inline constexpr int kLoopQuantities = 6;
const char* NameOf(LoopQuantity quantity);

// Pure: time is passed in. Recording takes a few ns; after construction only Total() allocates.
class LoopStatistics {
 public:
  // `role`, `host` and `session` go into each report; the first interval begins at `start`.
  LoopStatistics(std::string role, std::string host, int64_t session, bus::Clock::TimePoint start);

  // Records a cycle of the loop that began at `began`; loop_statistics_t says what `latency` is for the role.
  // The period is the time since the previous cycle began.
  void RecordCycle(bus::Clock::TimePoint began, bus::Clock::Duration latency) {
    ++current_.cycles;
    if (previous_began_) current_.period.Record(Nanoseconds(began - *previous_began_));
    previous_began_ = began;
    current_.latency.Record(Nanoseconds(latency));
  }

  // Records that the first command for a state arrived this long after the state was sent.
  void RecordRoundTrip(bus::Clock::Duration duration);

  // Counters of the whole run; a report holds what was added since the previous one. The increase in one call
  // counts as missed, or lost, in a row.
  void set_missed_deadlines(int64_t total) { Count(total, &total_missed_, LoopQuantity::kSkipped); }
  void set_lost_messages(int64_t total) { Count(total, &total_lost_, LoopQuantity::kGap); }
  int64_t lost_messages() const { return total_lost_; }
  void AddMissedDeadlines(int64_t count) { set_missed_deadlines(SaturatingSum(total_missed_, count)); }

  // Records the number of messages that are waiting now; a report holds the largest number since the previous
  // one.
  void RecordQueueDepth(int64_t depth);

  // The time at which Poll() has its next report.
  bus::Clock::TimePoint report_due() const { return current_.start + kReportPeriod; }

  // Returns the report that is due, once a second; null in between. The sender adds utime. Valid until the
  // next call.
  loop_statistics_t* Poll(bus::Clock::TimePoint now);

  // The same over the whole run so far, available at any time; marked as whole_run.
  loop_statistics_t Total(bus::Clock::TimePoint now) const;

  // Returns the histogram that is due, or null. Every two seconds all histograms take their turn, one a call,
  // so that no call of a loop has to send them all; empty ones are left out.
  loop_histogram_t* PollHistogram(bus::Clock::TimePoint now);

  // The time at which PollHistogram() has its next histogram; in the past while a turn goes on.
  bus::Clock::TimePoint histogram_due() const {
    return next_histogram_ < kLoopQuantities ? bus::Clock::TimePoint::min() : next_round_;
  }

  // The histogram of `quantity` so far, marked as whole_run; null when it is empty.
  loop_histogram_t* TotalHistogram(LoopQuantity quantity, bus::Clock::TimePoint now);

 private:
  static constexpr auto kReportPeriod = std::chrono::seconds(1);

  struct Interval {
    bus::Clock::TimePoint start{};
    int64_t cycles = 0;
    Histogram period;   // ns
    Histogram latency;  // ns
    int64_t missed_before = 0;
    int64_t lost_before = 0;
    int64_t queue_depth = 0;
  };

  void Fill(const Interval& interval, bus::Clock::TimePoint now, loop_statistics_t* report) const;
  loop_histogram_t* FillHistogram(int quantity, bus::Clock::TimePoint now);
  static int64_t Nanoseconds(bus::Clock::Duration duration) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
  }
  void Count(int64_t total, int64_t* counted, LoopQuantity in_a_row) {
    if (total == *counted) return;
    if (total > *counted) Whole(in_a_row).Record(total - *counted);
    *counted = total;
  }
  Histogram& Whole(LoopQuantity quantity) { return whole_[static_cast<size_t>(quantity)]; }

  loop_statistics_t report_;
  loop_histogram_t histogram_;
  int64_t sequence_ = 0;
  int64_t histogram_sequence_ = 0;
  int64_t total_missed_ = 0;
  int64_t total_lost_ = 0;
  std::optional<bus::Clock::TimePoint> previous_began_;
  bus::Clock::TimePoint start_;
  Interval current_;
  int64_t cycles_ = 0;       // of the reported intervals
  int64_t queue_depth_ = 0;  // of the reported intervals
  // Period and latency: of the reported intervals; others: of all.
  std::array<Histogram, kLoopQuantities> whole_;
  int next_histogram_ = kLoopQuantities;  // kLoopQuantities: all have been sent
  bus::Clock::TimePoint next_round_;      // when they are due again
};

}  // namespace hydro::timing
