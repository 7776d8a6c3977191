// A range that grows to hold values.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hydro::page {

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  bool empty() const { return !(low <= high); }
  // Ignores values that are not finite.
  void Include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void Include(const std::vector<double>& values) {
    for (const double value : values) Include(value);
  }
  // The range widened by an eighteenth on each side, and never empty.
  Range WithMargin() const {
    if (empty()) return {-1, 1};
    const double margin = high > low ? (high - low) / 18 : std::max(1e-6, std::abs(low) / 10);
    return {low - margin, high + margin};
  }
};

}  // namespace hydro::page
