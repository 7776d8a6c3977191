#include "diagnose/data/interval_means.h"

#include <algorithm>
#include <cmath>

namespace hydro::diagnose {
namespace {

constexpr size_t kIntervals = 150;
constexpr size_t kSamplesOfOne = 4;  // of an interval

}  // namespace

IntervalMeans::IntervalMeans(const runs::MeasuredRun& run)
    : length_(std::max(kSamplesOfOne, run.samples() / kIntervals)),
      count_(run.samples() / length_),
      time_(Means(run.time)) {}

std::vector<double> IntervalMeans::Means(const std::vector<double>& values) const {
  std::vector<double> means(count_, runs::kMissing);
  for (size_t i = 0; i < count_; ++i) {
    double sum = 0;
    size_t present = 0;
    for (size_t k = i * length_; k < (i + 1) * length_ && k < values.size(); ++k) {
      if (std::isnan(values[k])) continue;
      sum += values[k];
      ++present;
    }
    if (present > 0) means[i] = sum / static_cast<double>(present);
  }
  return means;
}

std::vector<double> IntervalMeans::Rates(const std::vector<double>& means) const {
  std::vector<double> rates(count_, runs::kMissing);
  for (size_t i = 1; i + 1 < count_; ++i)
    rates[i] = (means[i + 1] - means[i - 1]) / (time_[i + 1] - time_[i - 1]);
  return rates;
}

}  // namespace hydro::diagnose
