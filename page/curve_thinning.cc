#include "page/curve_thinning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace hydro::page {

std::vector<size_t> ThinLine(std::span<const double> x, std::span<const double> y,
                             const std::function<double(double)>& column) {
  std::vector<size_t> kept;
  // A logarithmic axis has no column for values of 0 or below.
  const auto finite = [&](size_t i) { return std::isfinite(column(x[i])) && std::isfinite(y[i]); };
  for (size_t begin = 0; begin < x.size();) {
    if (!finite(begin)) {
      kept.push_back(begin);
      while (begin < x.size() && !finite(begin)) ++begin;
      continue;
    }
    const double here = std::floor(column(x[begin]));
    size_t end = begin;
    size_t lowest = begin;
    size_t highest = begin;
    for (; end < x.size() && finite(end) && std::floor(column(x[end])) == here; ++end) {
      if (y[end] < y[lowest]) lowest = end;
      if (y[end] > y[highest]) highest = end;
    }
    std::array<size_t, 4> some = {begin, lowest, highest, end - 1};
    std::sort(some.begin(), some.end());
    kept.insert(kept.end(), some.begin(), std::unique(some.begin(), some.end()));
    begin = end;
  }
  return kept;
}

std::vector<size_t> ThinPoints(std::span<const double> x, std::span<const double> y,
                               const std::function<double(double)>& column,
                               const std::function<double(double)>& row) {
  std::vector<size_t> kept;
  std::set<std::pair<double, double>> taken;
  for (size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(column(x[i])) || !std::isfinite(row(y[i]))) continue;
    if (taken.emplace(std::floor(column(x[i])), std::floor(row(y[i]))).second) kept.push_back(i);
  }
  return kept;
}

}  // namespace hydro::page
