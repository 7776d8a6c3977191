#include "launch/logic/run_summary.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "base/integers.h"
#include "base/utf8.h"
#include "bus/output_left.h"
#include "process/fault_codes.h"
#include "process/status.h"
#include "runs/timing/timing_report.h"

namespace hydro::launch {
namespace {

constexpr double kMostOfASecond = 0.5;
// A stack has five processes and some forty codes; more would come from a flood of made-up ones.
constexpr size_t kMostLoops = 64;
constexpr size_t kMostFaults = 256;
constexpr size_t kMostOutputs = 256;
constexpr size_t kListedOutputs = 4;  // if there are more, those at zero volts are only counted
constexpr size_t kLongestText = 500;
constexpr size_t kWidestLine = 79;  // of a terminal of 80 columns
// The widths of the table of loops: with the longest label, "[position_ctrl] ", it has 79 columns, whatever
// the numbers are.
constexpr int kCycles = 7, kTime = 6, kLongestTime = 7, kMissed = 7, kLost = 5;

// Writes "18000k" when the digits of a number and a blank before them do not fit into this many columns.
std::string Fitted(double value, int columns) {
  std::string text = fmt::format("{:.0f}", value);
  for (const char* unit = "kMGTPE"; static_cast<int>(text.size()) >= columns && *unit != '\0'; ++unit) {
    value /= 1000;
    text = fmt::format("{:.0f}{}", value, *unit);
  }
  return fmt::format("{:>{}}", text, columns);
}

std::string Fitted(int64_t value, int columns) { return Fitted(static_cast<double>(value), columns); }

// A session identifies one sender; the name in a message that changed on the way may belong to another. Only
// the simulated joints of a limb have no session, and names then distinguish them.
bool SameSender(int64_t session, const std::string& name, int64_t other_session,
                const std::string& other_name) {
  return session == other_session && (session != 0 || name == other_name);
}

}  // namespace

void RunSummary::Add(const loop_statistics_t& report) {
  auto loop = std::find_if(loops_.begin(), loops_.end(),
                           [&](const Loop& known) { return known.shown.session == report.session; });
  if (loop == loops_.end()) {
    if (loops_.size() == kMostLoops) return;
    loop = loops_.insert(loops_.end(), Loop{});
    loop->shown = report;
  }
  if (report.whole_run) {
    *loop = Loop{report, report.cycles, report.missed_deadlines, report.lost_messages, report.latency_max_us};
    return;
  }
  // A process that was killed leaves only its periodic reports, and a report on a few cycles means little.
  if (report.interval_s >= kMostOfASecond || loop->shown.interval_s < kMostOfASecond) loop->shown = report;
  loop->cycles = SaturatingSum(loop->cycles, report.cycles);
  loop->missed_deadlines = SaturatingSum(loop->missed_deadlines, report.missed_deadlines);
  loop->lost_messages = SaturatingSum(loop->lost_messages, report.lost_messages);
  loop->latency_max_us = std::max(loop->latency_max_us, report.latency_max_us);
}

void RunSummary::Add(const fault_t& fault) {
  auto known = std::find_if(faults_.begin(), faults_.end(), [&](const Fault& other) {
    return other.first.code == fault.code &&
           SameSender(other.first.session, other.first.source, fault.session, fault.source);
  });
  if (known == faults_.end()) {
    if (faults_.size() == kMostFaults) return;
    known = faults_.insert(faults_.end(), Fault{});
    known->first = fault;
  }
  if (fault.active) known->last = fault.text;
  known->times += fault.active ? 1 : 0;
  known->active = fault.active;
}

void RunSummary::Add(const output_left_t& left) {
  const auto known = std::find_if(outputs_left_.begin(), outputs_left_.end(), [&](const output_left_t& one) {
    return SameSender(one.session, one.role, left.session, left.role);
  });
  if (known != outputs_left_.end()) {
    *known = left;
  } else if (outputs_left_.size() < kMostOutputs) {
    outputs_left_.push_back(left);
  }
}

std::vector<std::string> RunSummary::Lines() const {
  std::vector<std::string> lines;
  size_t width = 13;
  for (const Loop& loop : loops_) width = std::max(width, loop.shown.role.size());
  if (!loops_.empty()) {
    lines.push_back(fmt::format("{:>{}}{:>{}}", "period us", width + kCycles + 2 * kTime, "latency us",
                                2 * kTime + kLongestTime));
    lines.push_back(fmt::format("{:<{}}{:>{}}{:>{}}{:>{}}{:>{}}{:>{}}{:>{}}{:>{}}{:>{}}", "process", width,
                                "cycles", kCycles, "p50", kTime, "p99", kTime, "p50", kTime, "p99", kTime,
                                "max", kLongestTime, "missed", kMissed, "lost", kLost));
  }
  for (const Loop& loop : loops_) {
    const loop_statistics_t& s = loop.shown;
    lines.push_back(fmt::format("{:<{}}", s.role, width) + Fitted(loop.cycles, kCycles) +
                    Fitted(s.period_p50_us, kTime) + Fitted(s.period_p99_us, kTime) +
                    Fitted(s.latency_p50_us, kTime) + Fitted(s.latency_p99_us, kTime) +
                    Fitted(loop.latency_max_us, kLongestTime) + Fitted(loop.missed_deadlines, kMissed) +
                    Fitted(loop.lost_messages, kLost));
  }
  AppendFaults(&lines);
  AppendOutputs(&lines);
  return lines;
}

// A limit that the plant and the pressure loop both watch is passed once: what several see, in the same
// words, has one line.
void RunSummary::AppendFaults(std::vector<std::string>* lines) const {
  for (auto fault = faults_.begin(); fault != faults_.end(); ++fault) {
    const auto same = [&](const Fault& other) {
      return fault->first.code == other.first.code && fault->first.text == other.first.text;
    };
    if (std::any_of(faults_.begin(), fault, same)) continue;
    std::string seen;
    int senders = 0;
    for (auto other = fault; other != faults_.end(); ++other) {
      if (!same(*other)) continue;
      ++senders;
      seen += fmt::format("{}of {}, {}{}", seen.empty() ? "" : ", and ",
                          bus::ReasonText(other->first.source, "an unnamed process"),
                          other->times == 1 ? "once" : fmt::format("{} times", other->times),
                          other->active ? ", still there at the end" : "");
    }
    // One that is still there has the words in which it came last: others may have had another cause.
    const std::string& text = senders == 1 && fault->active ? fault->last : fault->first.text;
    lines->push_back(fmt::format("fault {} {}: {}", bus::ReasonText(fault->first.code, "without a name"),
                                 seen, FirstBytes(bus::ReasonText(text), kLongestText)));
  }
}

void RunSummary::AppendOutputs(std::vector<std::string>* lines) const {
  int64_t at_zero = 0;
  for (const output_left_t& left : outputs_left_) {
    const bool zero = outputs_left_.size() > kListedOutputs && left.accepted && left.voltage == 0;
    if (zero) {
      ++at_zero;
    } else {
      lines->push_back(bus::OutputLeftText(left));
    }
  }
  if (at_zero > 0) lines->push_back(fmt::format("{} outputs read back 0 V", at_zero));
}

std::vector<ProcessStatus> RunSummary::Status() const {
  std::vector<ProcessStatus> rows;
  rows.reserve(loops_.size());
  for (const Loop& loop : loops_) {
    const loop_statistics_t& s = loop.shown;
    ProcessStatus row{.role = s.role,
                      .rate_hz = s.interval_s > 0 ? static_cast<double>(s.cycles) / s.interval_s : 0,
                      .latency_p99_us = s.latency_p99_us,
                      .missed_deadlines = loop.missed_deadlines,
                      .lost_messages = loop.lost_messages,
                      .fault = {}};
    for (const Fault& fault : faults_) {
      if (fault.active && fault.first.session == s.session && row.fault.empty()) row.fault = fault.first.code;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string StatusLine(const ProcessStatus& status) {
  const std::string line =
      fmt::format("{:<14.14}{:>6.0f} Hz  p99 {:>6.0f} us  missed {:>4}  lost {:>3}  {}", status.role,
                  status.rate_hz, status.latency_p99_us, status.missed_deadlines, status.lost_messages,
                  status.fault.empty() ? "ok" : status.fault);
  return std::string(FirstBytes(line, kWidestLine));
}

std::string RunSummary::SkippedTicksAdvice(const std::string& config) const {
  for (const Loop& loop : loops_) {
    if (!process::IsPlant(loop.shown.role)) continue;
    const std::string advice = timing::SkippedTicksAdvice(
        loop.missed_deadlines, SaturatingSum(loop.cycles, loop.missed_deadlines), config);
    if (!advice.empty()) return loop.shown.role + ": " + advice;
  }
  return "";
}

std::string FaultsLeftText(const std::vector<std::string>& left) {
  if (left.empty()) return "";
  return fmt::format("the run ended with active faults: {}", fmt::join(left, ", "));
}

std::vector<std::string> RunSummary::FaultsLeft(
    const std::function<bool(int64_t session)>& is_foreign) const {
  std::vector<std::string> left;
  for (const Fault& fault : faults_) {
    if (is_foreign && is_foreign(fault.first.session)) continue;
    const std::string name = bus::ReasonText(fault.first.code, "a fault without a name") + " of " +
                             bus::ReasonText(fault.first.source, "an unnamed process");
    const bool known = std::find(left.begin(), left.end(), name) != left.end();  // of another session
    if (fault.active && !process::IsWarning(fault.first.code) && !known) left.push_back(name);
  }
  return left;
}

}  // namespace hydro::launch
