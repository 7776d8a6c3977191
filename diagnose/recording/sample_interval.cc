#include "diagnose/recording/sample_interval.h"

#include <cstddef>
#include <string>
#include <utility>

#include "base/maths/median.h"

namespace hydro::diagnose {

double MedianInterval(const std::vector<const std::vector<double>*>& times) {
  std::vector<double> intervals;
  for (const std::vector<double>* time : times) {
    for (size_t i = 1; i < time->size(); ++i) intervals.push_back((*time)[i] - (*time)[i - 1]);
  }
  if (intervals.empty()) return 1;
  return maths::Median(std::move(intervals));
}

double MedianInterval(const std::vector<double>& time) { return MedianInterval(std::vector{&time}); }

std::string TimeUnitHint(double interval) {
  constexpr double kFastestSamples = 2e-5, kUsualSamples = 0.1;  // s
  if (interval <= kSlowestSamples) return "";
  for (const auto& [unit, size] : {std::pair("ms", 1e-3), std::pair("us", 1e-6), std::pair("ns", 1e-9)}) {
    if (interval * size < kFastestSamples || interval * size > kUsualSamples) continue;
    return std::string(" (is the column in ") + unit + "? unit = \"" + unit + "\")";
  }
  return "";
}

}  // namespace hydro::diagnose
