#include "bus/loop_statistics.h"

#include <algorithm>
#include <utility>

namespace hydro {
namespace {

constexpr auto kReportPeriod = std::chrono::seconds(1);

int64_t Nanoseconds(Clock::Duration duration) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
}

double Microseconds(int64_t nanoseconds) { return 1e-3 * static_cast<double>(nanoseconds); }

}  // namespace

LoopStatistics::LoopStatistics(std::string role, std::string host, int64_t session, Clock::TimePoint start)
    : role_(std::move(role)), host_(std::move(host)), session_(session) {
  current_.start = start;
  run_.start = start;
}

void LoopStatistics::RecordCycle(Clock::TimePoint began, Clock::Duration latency) {
  ++current_.cycles;
  if (previous_began_) current_.period.Record(Nanoseconds(began - *previous_began_));
  previous_began_ = began;
  current_.latency.Record(Nanoseconds(latency));
}

void LoopStatistics::RecordQueueDepth(int64_t depth) {
  current_.queue_depth = std::max(current_.queue_depth, depth);
}

std::optional<loop_statistics_t> LoopStatistics::Poll(Clock::TimePoint now) {
  if (now - current_.start < kReportPeriod) return std::nullopt;
  loop_statistics_t report = Report(current_, now);
  report.sequence = sequence_++;
  run_.cycles += current_.cycles;
  run_.period.Merge(current_.period);
  run_.latency.Merge(current_.latency);
  run_.queue_depth = std::max(run_.queue_depth, current_.queue_depth);
  current_.start = now;
  current_.cycles = 0;
  current_.period.Reset();
  current_.latency.Reset();
  current_.missed_before = total_missed_;
  current_.lost_before = total_lost_;
  current_.queue_depth = 0;
  return report;
}

loop_statistics_t LoopStatistics::Total(Clock::TimePoint now) const {
  Interval all = run_;
  all.cycles += current_.cycles;
  all.period.Merge(current_.period);
  all.latency.Merge(current_.latency);
  all.queue_depth = std::max(all.queue_depth, current_.queue_depth);
  loop_statistics_t report = Report(all, now);
  report.whole_run = true;
  report.sequence = sequence_;
  return report;
}

loop_statistics_t LoopStatistics::Report(const Interval& interval, Clock::TimePoint now) const {
  loop_statistics_t report{};
  report.session = session_;
  report.role = role_;
  report.host = host_;
  report.interval_s = std::chrono::duration<double>(now - interval.start).count();
  report.cycles = interval.cycles;
  report.period_p50_us = Microseconds(interval.period.Percentile(50));
  report.period_p99_us = Microseconds(interval.period.Percentile(99));
  report.period_p999_us = Microseconds(interval.period.Percentile(99.9));
  report.period_max_us = Microseconds(interval.period.Max());
  report.latency_p50_us = Microseconds(interval.latency.Percentile(50));
  report.latency_p99_us = Microseconds(interval.latency.Percentile(99));
  report.latency_p999_us = Microseconds(interval.latency.Percentile(99.9));
  report.latency_max_us = Microseconds(interval.latency.Max());
  report.missed_deadlines = total_missed_ - interval.missed_before;
  report.lost_messages = total_lost_ - interval.lost_before;
  report.queue_depth = interval.queue_depth;
  return report;
}

}  // namespace hydro
