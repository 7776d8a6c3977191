#include "process/timing/loop_statistics.h"

#include <algorithm>
#include <utility>

namespace hydro::timing {
namespace {

constexpr auto kHistogramPeriod = std::chrono::seconds(2);
constexpr size_t kMostBuckets = 700;  // more than Histogram::ForEachRange() can give

double Microseconds(int64_t nanoseconds) { return 1e-3 * static_cast<double>(nanoseconds); }

}  // namespace

const char* NameOf(LoopQuantity quantity) {
  static constexpr std::array<const char*, kLoopQuantities> kNames{"period",      "latency", "round_trip",
                                                                   "queue_depth", "gap",     "skipped"};
  return kNames[static_cast<size_t>(quantity)];
}

LoopStatistics::LoopStatistics(std::string role, std::string host, int64_t session,
                               bus::Clock::TimePoint start)
    : report_{}, histogram_{}, start_(start), next_round_(start + kHistogramPeriod) {
  report_.role = histogram_.role = std::move(role);
  report_.host = histogram_.host = std::move(host);
  report_.session = histogram_.session = session;
  histogram_.quantity.reserve(32);
  for (auto* list : {&histogram_.bucket_first, &histogram_.bucket_last, &histogram_.bucket_count}) {
    list->reserve(kMostBuckets);
  }
  current_.start = start;
}

void LoopStatistics::RecordRoundTrip(bus::Clock::Duration duration) {
  Whole(LoopQuantity::kRoundTrip).Record(Nanoseconds(duration));
}

void LoopStatistics::RecordQueueDepth(int64_t depth) {
  current_.queue_depth = std::max(current_.queue_depth, depth);
  Whole(LoopQuantity::kQueueDepth).Record(depth);
}

loop_statistics_t* LoopStatistics::Poll(bus::Clock::TimePoint now) {
  if (now < report_due()) return nullptr;
  Fill(current_, now, &report_);
  report_.sequence = sequence_++;
  cycles_ += current_.cycles;
  Whole(LoopQuantity::kPeriod).Merge(current_.period);
  Whole(LoopQuantity::kLatency).Merge(current_.latency);
  queue_depth_ = std::max(queue_depth_, current_.queue_depth);
  current_.start = now;
  current_.cycles = 0;
  current_.period.Reset();
  current_.latency.Reset();
  current_.missed_before = total_missed_;
  current_.lost_before = total_lost_;
  current_.queue_depth = 0;
  return &report_;
}

loop_statistics_t LoopStatistics::Total(bus::Clock::TimePoint now) const {
  Interval all;
  all.start = start_;
  all.cycles = cycles_ + current_.cycles;
  all.period = whole_[static_cast<size_t>(LoopQuantity::kPeriod)];
  all.period.Merge(current_.period);
  all.latency = whole_[static_cast<size_t>(LoopQuantity::kLatency)];
  all.latency.Merge(current_.latency);
  all.queue_depth = std::max(queue_depth_, current_.queue_depth);
  loop_statistics_t report = report_;
  Fill(all, now, &report);
  report.whole_run = true;
  report.sequence = sequence_;
  return report;
}

void LoopStatistics::Fill(const Interval& interval, bus::Clock::TimePoint now,
                          loop_statistics_t* report) const {
  report->interval_s = std::chrono::duration<double>(now - interval.start).count();
  report->cycles = interval.cycles;
  report->period_p50_us = Microseconds(interval.period.Percentile(50));
  report->period_p99_us = Microseconds(interval.period.Percentile(99));
  report->period_p999_us = Microseconds(interval.period.Percentile(99.9));
  report->period_max_us = Microseconds(interval.period.Max());
  report->latency_p50_us = Microseconds(interval.latency.Percentile(50));
  report->latency_p99_us = Microseconds(interval.latency.Percentile(99));
  report->latency_p999_us = Microseconds(interval.latency.Percentile(99.9));
  report->latency_max_us = Microseconds(interval.latency.Max());
  report->missed_deadlines = total_missed_ - interval.missed_before;
  report->lost_messages = total_lost_ - interval.lost_before;
  report->queue_depth = interval.queue_depth;
}

loop_histogram_t* LoopStatistics::PollHistogram(bus::Clock::TimePoint now) {
  if (now >= next_round_) {
    next_round_ = now + kHistogramPeriod;
    next_histogram_ = 0;
  }
  while (next_histogram_ < kLoopQuantities) {
    if (loop_histogram_t* due = FillHistogram(next_histogram_++, now)) return due;
  }
  return nullptr;
}

loop_histogram_t* LoopStatistics::TotalHistogram(LoopQuantity quantity, bus::Clock::TimePoint now) {
  const bool by_interval = quantity == LoopQuantity::kPeriod || quantity == LoopQuantity::kLatency;
  Histogram& whole = Whole(quantity);
  const Histogram before = whole;  // what has not been reported yet still belongs in the next report
  if (by_interval) whole.Merge(quantity == LoopQuantity::kPeriod ? current_.period : current_.latency);
  loop_histogram_t* const total = FillHistogram(static_cast<int>(quantity), now);
  whole = before;
  if (total != nullptr) total->whole_run = true;
  return total;
}

loop_histogram_t* LoopStatistics::FillHistogram(int quantity, bus::Clock::TimePoint now) {
  const Histogram& whole = whole_[static_cast<size_t>(quantity)];
  if (whole.Count() == 0) return nullptr;
  histogram_.sequence = histogram_sequence_++;
  histogram_.quantity = NameOf(static_cast<LoopQuantity>(quantity));
  histogram_.whole_run = false;
  histogram_.interval_s = std::chrono::duration<double>(now - start_).count();
  histogram_.count = whole.Count();
  histogram_.lowest = whole.Min();
  histogram_.highest = whole.Max();
  for (auto* list : {&histogram_.bucket_first, &histogram_.bucket_last, &histogram_.bucket_count})
    list->clear();
  whole.ForEachRange([this](int64_t first, int64_t last, int64_t count) {
    histogram_.bucket_first.push_back(first);
    histogram_.bucket_last.push_back(last);
    histogram_.bucket_count.push_back(count);
  });
  histogram_.buckets = static_cast<int32_t>(histogram_.bucket_first.size());
  return &histogram_;
}

}  // namespace hydro::timing
