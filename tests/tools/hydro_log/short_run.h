// The configuration of a short run in lockstep, whose log tests damage and replay.
#pragma once

#include <string>

namespace hydro::hydro_log {

// `more` is further sections.
inline std::string ShortRun(const std::string& duration_s, const std::string& more = "") {
  return R"(
[model]
shaft = "free"
[time]
mode = "lockstep"
duration_s = )" +
         duration_s + R"(
[plant]
rate_hz = 1000
[pressure]
natural_frequency_rad_s = 150.0
damping_ratio = 0.5
[position]
sample_interval_s = 0.005
c1 = 1000.0
c2 = 200.0
[reference]
kind = "steps"
steps = [[0.05, 0.1]]
)" + more;
}

}  // namespace hydro::hydro_log
