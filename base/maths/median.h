#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hydro::maths {

// The middle value; for an even number of values, the upper of the two. There must be at least one value, and
// none may be NaN.
inline double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace hydro::maths
