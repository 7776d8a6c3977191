// How numbers spread, their range and their median, and on what they depend. Infinite numbers are allowed,
// NaN is not, but in RangeOf().
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace hydro::maths {

// The smallest and the largest of some values; low is above high when there are none.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  double size() const { return high - low; }
};

// The range of all values that are not NaN.
inline Range RangeOf(const std::vector<double>& values) {
  Range range;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range;
}

// The middle value; for an even number of values, the upper of the two. There must be at least one value, and
// none may be NaN.
template <class Value>
Value Median(std::vector<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// A value with its 95 % confidence interval.
struct Estimate {
  double value = 0;
  double low = 0;
  double high = 0;

  double half_width() const { return (high - low) / 2; }
};

// "4.000017 +/- 0.000075", with as many decimals as the interval justifies.
std::string PlusMinus(const Estimate& estimate);

// The value that the share `share` (0 to 1) of `sorted` (increasing, not empty) does not exceed; between its
// numbers, straight lines interpolate.
double Quantile(const std::vector<double>& sorted, double share);

// Estimates a share from `hits` of `count` independent trials: Wilson's 95 % interval.
Estimate Share(int hits, int count);

// Pearson's correlation of two lists of equal length, -1 to 1. 0 when either list is constant.
double Correlation(const std::vector<double>& x, const std::vector<double>& y);

// Spearman's rank correlation of two lists of equal length, -1 to 1: how far y rises with x, along any curve.
// Equal numbers share a rank. 0 when either list is constant.
double RankCorrelation(const std::vector<double>& x, const std::vector<double>& y);

// The part of y's variance that goes with x alone, along any curve, up or down. It is the variance of y's
// means over `bins` ranges of x with equally many points each, divided by y's variance, less the share that
// chance gives this many bins (Kelley's epsilon squared; it may come out slightly below 0). When all of y's
// causes are independent, these parts add up to at most 1 (the first-order indices of Sobol). 0 when y is
// constant.
double MainEffect(const std::vector<double>& x, const std::vector<double>& y, int bins);

}  // namespace hydro::maths
