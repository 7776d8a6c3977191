#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
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

}  // namespace hydro::maths
