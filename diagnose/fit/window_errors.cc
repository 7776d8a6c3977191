#include "diagnose/fit/window_errors.h"

#include <algorithm>
#include <cmath>

#include "maths/median.h"

namespace hydro::diagnose {
namespace {

// How badly one window is predicted: the logarithms of its signals' squared errors. Below 1, no signal counts.
double Badness(const PredictionErrors& errors) {
  double sum = 0;
  for (const double error : errors) {
    if (!std::isnan(error)) sum += std::log(std::max(1.0, error));
  }
  return sum;
}

}  // namespace

double MedianBadness(const std::vector<PredictionErrors>& windows) {
  std::vector<double> all;
  all.reserve(windows.size());
  for (const PredictionErrors& errors : windows) all.push_back(Badness(errors));
  return maths::Median(all);
}

double Gain(const std::vector<PredictionErrors>& from, const std::vector<PredictionErrors>& to) {
  std::vector<double> gains;
  for (size_t w = 0; w < to.size(); ++w) {
    PredictionErrors before = from[w];
    for (size_t c = 0; c < model::kChannels; ++c) {
      if (std::isnan(to[w][c])) before[c] = to[w][c];
    }
    gains.push_back(Badness(before) - Badness(to[w]));
  }
  return maths::Median(gains);
}

}  // namespace hydro::diagnose
