// Finds the steps of a sensor that counts, from its values.
#include <algorithm>
#include <cmath>

#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {
namespace {

// The unit of which nearly all steps are multiples; 0: none.
double CommonUnit(const std::vector<double>& steps) {
  // A table's digits round the steps, so use the mean of the smallest steps.
  double smallest = *std::ranges::min_element(steps);
  for (int pass = 0; pass < 3; ++pass) {
    double sum = 0, count = 0;
    for (const double step : steps) {
      if (step > 1.25 * smallest) continue;
      sum += step;
      count += 1;
    }
    if (count > 0) smallest = sum / count;
  }
  // In a fast motion no values may be a single unit apart.
  for (const int part : {1, 2, 3, 4}) {
    const double guess = smallest / part;
    double sum = 0, units = 0;
    size_t multiples = 0;
    for (const double step : steps) {
      const double count = std::round(step / guess);
      if (std::abs(step / guess - count) > 0.1) continue;
      ++multiples;
      // With many units between values, the error of the guess adds up.
      if (count > part) continue;
      sum += step;
      units += count;
    }
    // By chance, one step in five is a multiple.
    if (10 * multiples >= 9 * steps.size() && units > 0) return sum / units;
  }
  return 0;
}

// Whether nearly every row is one unit further than the row before, in one direction. The unit is then the
// motion in one row, and shows no sensor's steps.
bool IsSteadyMotion(const std::vector<double>& values, double unit) {
  size_t all = 0, forward = 0, backward = 0;
  for (size_t i = 1; i < values.size(); ++i) {
    const double step = values[i] - values[i - 1];
    if (std::isnan(step)) continue;
    ++all;
    if (std::abs(step - unit) < 0.1 * unit) ++forward;
    if (std::abs(step + unit) < 0.1 * unit) ++backward;
  }
  return 10 * std::max(forward, backward) > 9 * all;
}

}  // namespace

double EstimateResolution(const std::vector<double>& values) {
  std::vector<double> sorted;
  for (const double value : values) {
    if (std::isfinite(value)) sorted.push_back(value);
  }
  if (sorted.empty()) return 0;
  std::ranges::sort(sorted);
  // Differences within the rounding of the arithmetic are not steps.
  const double same = 1e-12 * std::max(std::abs(sorted.front()), std::abs(sorted.back()));
  std::vector<double> steps;
  for (size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] - sorted[i - 1] > same) steps.push_back(sorted[i] - sorted[i - 1]);
  }
  if (steps.empty()) return 0;
  const double unit = CommonUnit(steps);
  return unit > 0 && !IsSteadyMotion(values, unit) ? unit : 0;
}

}  // namespace hydro::diagnose
