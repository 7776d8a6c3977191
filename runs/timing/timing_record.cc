#include "runs/timing/timing_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "base/integers.h"

namespace hydro::timing {
namespace {

// More processes than any stack has, and more reports than any run has seconds. A flood beyond these limits
// is dropped.
constexpr size_t kMostProcesses = 256;
constexpr size_t kMostReports = 1'000'000;
constexpr size_t kMostQuantities = 32;

TimingHistogram Read(const loop_histogram_t& message) {
  TimingHistogram histogram{message.count, message.lowest, message.highest, {}};
  // A reused decoder may hold lists longer than those of this message.
  const auto ranges =
      std::min({static_cast<size_t>(std::max(message.buckets, 0)), message.bucket_first.size(),
                message.bucket_last.size(), message.bucket_count.size()});
  for (size_t i = 0; i < ranges; ++i) {
    if (message.bucket_count[i] <= 0 || message.bucket_first[i] > message.bucket_last[i]) continue;
    histogram.ranges.push_back({message.bucket_first[i], message.bucket_last[i], message.bucket_count[i]});
  }
  return histogram;
}

// The role in a name: "plant" in "knee plant", the plant of a limb's joint.
std::string RoleIn(const std::string& name) { return name.substr(name.rfind(' ') + 1); }

size_t PlaceOf(const std::string& role) {
  static const std::array<std::string, 6> kOrder{"limb",          "plant",         "driver",
                                                 "pressure_ctrl", "position_ctrl", "logger"};
  return static_cast<size_t>(std::find(kOrder.begin(), kOrder.end(), role) - kOrder.begin());
}

double Sum(double a, double b) { return a + b; }
int64_t Sum(int64_t a, int64_t b) { return SaturatingSum(a, b); }

// Sums the periodic reports of a process that never sent its final one.
loop_statistics_t Sum(const std::vector<loop_statistics_t>& reports) {
  loop_statistics_t total = reports.back();
  const auto add = [&](auto member) {
    total.*member = 0;
    for (const loop_statistics_t& report : reports) total.*member = Sum(total.*member, report.*member);
  };
  const auto largest = [&](auto member) {
    for (const loop_statistics_t& report : reports) total.*member = std::max(total.*member, report.*member);
  };
  add(&loop_statistics_t::interval_s);
  add(&loop_statistics_t::cycles);
  add(&loop_statistics_t::missed_deadlines);
  add(&loop_statistics_t::lost_messages);
  largest(&loop_statistics_t::period_max_us);
  largest(&loop_statistics_t::latency_max_us);
  largest(&loop_statistics_t::queue_depth);
  return total;
}

}  // namespace

double TimingHistogram::Percentile(double percent) const {
  int64_t in_all = 0;
  for (const Range& range : ranges) in_all = SaturatingSum(in_all, range.count);
  const auto rank = static_cast<int64_t>(
      std::ceil(std::clamp(percent, 0.0, 100.0) / 100 * static_cast<double>(in_all) - 1e-6));
  int64_t below = 0;
  for (const Range& range : ranges) {
    below = SaturatingSum(below, range.count);
    if (below >= rank && below < in_all) {
      const double middle = 0.5 * (static_cast<double>(range.first) + static_cast<double>(range.last));
      return std::clamp(middle, static_cast<double>(lowest), static_cast<double>(highest));
    }
  }
  return static_cast<double>(highest);
}

TimingRecord::Heard* TimingRecord::Find(int64_t session) {
  const auto found = processes_.find(session);
  if (found != processes_.end()) return &found->second;
  return processes_.size() < kMostProcesses ? &processes_[session] : nullptr;
}

void TimingRecord::Add(const loop_statistics_t& report) {
  Heard* const process = Find(report.session);
  if (process == nullptr || process->reports.size() >= kMostReports) return;
  process->reports.insert_or_assign(report.sequence, report);
}

void TimingRecord::Add(const loop_histogram_t& histogram) {
  Heard* const process = Find(histogram.session);
  if (process == nullptr) return;
  const auto known = process->histograms.find(histogram.quantity);
  if (known == process->histograms.end()) {
    if (process->histograms.size() < kMostQuantities)
      process->histograms.emplace(histogram.quantity, histogram);
  } else if (histogram.sequence > known->second.sequence) {
    known->second = histogram;
  }
}

std::vector<TimedProcess> TimingRecord::Processes() const {
  std::vector<TimedProcess> processes;
  for (const auto& [session, heard] : processes_) {
    TimedProcess process;
    process.session = session;
    process.total.session = session;
    for (const auto& [sequence, report] : heard.reports) {
      process.role = report.role;
      process.host = report.host;
      if (report.whole_run) {
        process.complete = true;
        process.total = report;
      } else {
        process.reports.push_back(report);
      }
    }
    for (const auto& [quantity, histogram] : heard.histograms) {
      process.role = histogram.role;
      process.host = histogram.host;
      process.histograms.emplace(quantity, Read(histogram));
    }
    if (!process.complete && !process.reports.empty()) process.total = Sum(process.reports);
    processes.push_back(std::move(process));
  }
  std::stable_sort(processes.begin(), processes.end(), [](const TimedProcess& a, const TimedProcess& b) {
    return std::tuple(PlaceOf(RoleIn(a.role)), a.role, a.session) <
           std::tuple(PlaceOf(RoleIn(b.role)), b.role, b.session);
  });
  return processes;
}

const char* MeaningOfLatency(const std::string& name) {
  const std::string role = RoleIn(name);
  if (role == "plant" || role == "driver" || role == "limb") return "wake-up after its deadline";
  if (role == "logger") return "arrival of a message to its write";
  return "arrival of a state to the command sent";
}

}  // namespace hydro::timing
