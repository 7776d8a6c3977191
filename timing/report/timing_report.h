// How the loops of a run kept time, for programs, for a terminal and for a browser.
#pragma once

#include <string>
#include <vector>

#include "timing/report/timing_record.h"

namespace hydro::timing {

// JSON; times in microseconds, docs/performance.md lists the keys. `source`: where it comes from, e.g. the
// name of a log.
std::string TimingJson(const std::vector<TimedProcess>& processes, const std::string& source);

// A table for a terminal; several lines.
std::string TimingText(const std::vector<TimedProcess>& processes);

// A page (HTML) that needs nothing but itself: the table, and plots of each process.
std::string TimingPage(const std::vector<TimedProcess>& processes, const std::string& source);

}  // namespace hydro::timing
