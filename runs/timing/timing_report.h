// Reports how well the loops of a run kept time: for programs, a terminal and a browser.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runs/timing/timing_record.h"

namespace hydro::timing {

// JSON with times in microseconds; docs/developers/performance.md lists the keys. `source` names the origin,
// e.g. a log.
std::string TimingJson(const std::vector<TimedProcess>& processes, const std::string& source);

// A table for a terminal, with several lines.
std::string TimingText(const std::vector<TimedProcess>& processes);

// Whether a loop that has skipped that many of its ticks is not the loop at its rate any more.
bool ManySkipped(int64_t skipped, int64_t ticks);

// Advice for a plant that slept through that many of its ticks; empty where these are few. `config` is the
// configuration's name.
std::string SkippedTicksAdvice(int64_t skipped, int64_t ticks, const std::string& config);

// A self-contained HTML page with the table, and with plots for each process.
std::string TimingPage(const std::vector<TimedProcess>& processes, const std::string& source);

}  // namespace hydro::timing
