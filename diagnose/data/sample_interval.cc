#include "diagnose/data/sample_interval.h"

#include <algorithm>
#include <cstddef>

namespace hydro::diagnose {

double MedianInterval(const std::vector<const std::vector<double>*>& times) {
  std::vector<double> intervals;
  for (const std::vector<double>* time : times) {
    for (size_t i = 1; i < time->size(); ++i) intervals.push_back((*time)[i] - (*time)[i - 1]);
  }
  if (intervals.empty()) return 1;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

double MedianInterval(const std::vector<double>& time) { return MedianInterval(std::vector{&time}); }

}  // namespace hydro::diagnose
