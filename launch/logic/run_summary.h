// Summarises a run's statistics and faults in a table for the end of a launch.
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/fault_t.hpp>
#include <hydro/loop_statistics_t.hpp>
#include <hydro/output_left_t.hpp>
#include <string>
#include <vector>

namespace hydro::launch {

// The state of a process, for the line that is drawn while the run goes on.
struct ProcessStatus {
  std::string role;
  double rate_hz = 0;            // of its loop, over its last report
  double latency_p99_us = 0;     // of its loop, over its last report
  int64_t missed_deadlines = 0;  // since the run began
  int64_t lost_messages = 0;
  std::string fault;  // code of an active fault; empty: none
};

// "plant           1000 Hz  p99     34 us  missed    0  lost   0  ok": rate, lateness, and a fault; at most
// 79 characters.
std::string StatusLine(const ProcessStatus& status);

// "the run ended with active faults: CODE of SOURCE, ...", of what
// RunSummary::FaultsLeft() returns; empty when that is. A run that has such a text has failed.
std::string FaultsLeftText(const std::vector<std::string>& left);

class RunSummary {
 public:
  void Add(const loop_statistics_t& report);
  void Add(const fault_t& fault);
  void Add(const output_left_t& left);

  // One line per process, one per fault whoever sees it, and one per plant or driver on what it left.
  // Percentiles come from the process's report on its whole run or, without one, from its last report that
  // covers most of a second. The largest latency, missed deadlines and lost messages are those of the whole
  // run. Empty when nothing was reported. Times are in microseconds, with or without --si.
  std::vector<std::string> Lines() const;

  // Advice for when a plant, driver or limb has slept through a part of its ticks; empty when none has.
  std::string SkippedTicksAdvice(const std::string& config) const;

  bool says_what_was_left() const { return !outputs_left_.empty(); }

  // A row for each process that has reported, in the order of their first reports.
  std::vector<ProcessStatus> Status() const;

  // "CODE of SOURCE" for every fault that was still active at the end and is more than a warning, each once,
  // whatever the session. `is_foreign` says which sessions belong to another stack on the same port, whose
  // faults are left out; empty: none does.
  std::vector<std::string> FaultsLeft(const std::function<bool(int64_t session)>& is_foreign = {}) const;

 private:
  void AppendFaults(std::vector<std::string>* lines) const;
  void AppendOutputs(std::vector<std::string>* lines) const;

  struct Loop {
    loop_statistics_t shown;  // whose percentiles are printed
    int64_t cycles = 0;
    int64_t missed_deadlines = 0;
    int64_t lost_messages = 0;
    double latency_max_us = 0;
  };
  struct Fault {
    fault_t first;
    std::string last;  // its text when it came last
    int64_t times = 0;
    bool active = false;
  };

  std::vector<Loop> loops_;  // by session, in order of their first report
  std::vector<output_left_t> outputs_left_;
  std::vector<Fault> faults_;  // by sender and code, in order of their first appearance
};

}  // namespace hydro::launch
