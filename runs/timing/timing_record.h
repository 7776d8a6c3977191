// What a run's processes reported about their loops. Every timing report is made from this.
#pragma once

#include <cstdint>
#include <hydro/loop_histogram_t.hpp>
#include <hydro/loop_statistics_t.hpp>
#include <map>
#include <string>
#include <vector>

namespace hydro::timing {

// How often each value occurred over the whole run. Times are in ns.
struct TimingHistogram {
  struct Range {
    int64_t first = 0;  // smallest and largest value in the range
    int64_t last = 0;
    int64_t count = 0;
  };
  int64_t count = 0;
  int64_t lowest = 0;  // exact
  int64_t highest = 0;
  std::vector<Range> ranges;  // in rising order, none empty

  // The value that `percent` (0 to 100) of the records do not exceed, to within 1/32. 100 gives `highest`.
  double Percentile(double percent) const;
};

// The loop of one process.
struct TimedProcess {
  std::string role;
  std::string host;
  int64_t session = 0;
  bool complete = false;  // it reported its whole run on exit; otherwise it was killed, or the log is cut off
  // Over the whole run. If the process is not complete, the percentiles are those of its last report.
  loop_statistics_t total;
  std::vector<loop_statistics_t> reports;             // one per second, by sequence
  std::map<std::string, TimingHistogram> histograms;  // by loop_histogram_t's quantity names
};

class TimingRecord {
 public:
  // Takes messages in any order. A message that comes twice counts once.
  void Add(const loop_statistics_t& report);
  void Add(const loop_histogram_t& histogram);

  // In the order of cause and effect: plant or driver, pressure loop, position loop, logger, others.
  std::vector<TimedProcess> Processes() const;

 private:
  struct Heard {
    std::map<int64_t, loop_statistics_t> reports;
    std::map<std::string, loop_histogram_t> histograms;  // the newest of each quantity
  };
  Heard* Find(int64_t session);

  std::map<int64_t, Heard> processes_;  // by session
};

// The meaning of `latency` for a role, in a few words.
const char* MeaningOfLatency(const std::string& name);

}  // namespace hydro::timing
