#include "runs/measured/sample_times.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/input_error.h"
#include "base/maths/spread.h"
#include "base/number_text.h"

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

double MedianInterval(const std::vector<const std::vector<double>*>& times) {
  std::vector<double> intervals;
  for (const std::vector<double>* time : times) {
    for (size_t i = 1; i < time->size(); ++i) intervals.push_back((*time)[i] - (*time)[i - 1]);
  }
  if (intervals.empty()) return 1;
  return maths::Median(std::move(intervals));
}

double MedianInterval(const std::vector<double>& time) { return MedianInterval(std::vector{&time}); }

std::string TimeUnitHint(double interval, double scale) {
  constexpr double kFastestUsual = 2e-5, kSlowestUsual = 0.1;  // s
  if (interval >= kFastestSamples && interval <= kSlowestSamples) return "";
  for (const auto& [unit, size] :
       {std::pair("s", 1.0), std::pair("ms", 1e-3), std::pair("us", 1e-6), std::pair("ns", 1e-9)}) {
    const double meant = interval / scale * size;
    if (meant < kFastestUsual || meant > kSlowestUsual) continue;
    return std::string(" (is the column in ") + unit + "? unit = \"" + unit + "\")";
  }
  return " (is the column in another unit?)";
}

void RequirePossibleSamples(const MeasuredRun& run) {
  if (run.samples() < 2) return;
  const double interval = MedianInterval(run.time);
  const bool slow = interval > kSlowestSamples;
  if (!slow && interval >= kFastestSamples) return;
  throw InputError(
      run.file + ": time: found rows " + ShortNumber(interval) + " s apart, allowed " +
      (slow ? "at most " + ShortNumber(kSlowestSamples) + " s: slower ones show no motion of such a machine"
            : "at least " + ShortNumber(kFastestSamples) + " s: no recorder of such a machine is faster") +
      TimeUnitHint(interval, run.time_source.scale));
}

}  // namespace hydro::runs
