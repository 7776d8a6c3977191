#include "diagnose/recording/sample_interval.h"

#include <cstddef>
#include <string>
#include <utility>

#include "base/maths/spread.h"

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

}  // namespace hydro::diagnose
