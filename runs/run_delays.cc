#include "runs/run_delays.h"

#include <algorithm>
#include <cstddef>

namespace hydro::runs {
namespace {

size_t Nearest(const std::vector<double>& time, double at) {
  const auto after = std::lower_bound(time.begin(), time.end(), at);
  if (after == time.begin()) return 0;
  if (after == time.end()) return time.size() - 1;
  const auto place = static_cast<size_t>(after - time.begin());
  return time[place] - at < at - time[place - 1] ? place : place - 1;
}

}  // namespace

bool RemoveDelays(const std::vector<SignalDelay>& delays, MeasuredRun* run) {
  const std::vector<double>& time = run->time;
  double latest = 0, earliest = 0;
  for (const auto& [signal, delay] : delays) {
    latest = std::max(latest, delay);
    earliest = std::min(earliest, delay);
  }
  // A margin of half a millionth, because the times in a table are rounded.
  const double margin = 5e-7 * (time.back() - time.front());
  const auto first = static_cast<size_t>(
      std::lower_bound(time.begin(), time.end(), time.front() - earliest - margin) - time.begin());
  const auto last = static_cast<size_t>(
      std::upper_bound(time.begin(), time.end(), time.back() - latest + margin) - time.begin());
  if (last < first + 2) return false;
  for (const auto& [signal, delay] : delays) {
    std::vector<double>& values = (run->*signal).values;
    if (values.empty() || delay == 0) continue;
    std::vector<double> moved(values.size());
    for (size_t i = first; i < last; ++i) moved[i] = values[Nearest(time, time[i] + delay)];
    values = std::move(moved);
  }
  run->Keep(first, last);
  return true;
}

}  // namespace hydro::runs
