// Saturating sums and differences, for whole numbers from messages and files, which may have any value.
#pragma once

#include <cstdint>
#include <limits>

namespace hydro {

// a - b, or the nearest value that an int64_t can hold.
inline int64_t SaturatingDifference(int64_t a, int64_t b) {
  int64_t difference;
  if (!__builtin_sub_overflow(a, b, &difference)) return difference;
  return a < b ? std::numeric_limits<int64_t>::min() : std::numeric_limits<int64_t>::max();
}

// a + b, or the nearest value that an int64_t can hold.
inline int64_t SaturatingSum(int64_t a, int64_t b) {
  int64_t sum;
  if (!__builtin_add_overflow(a, b, &sum)) return sum;
  return a < 0 ? std::numeric_limits<int64_t>::min() : std::numeric_limits<int64_t>::max();
}

}  // namespace hydro
