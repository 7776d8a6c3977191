// Arithmetic of whole numbers. Those from messages and files may have any value: their sums and differences
// saturate.
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

// Finds multiples of a fixed number without a division, for numbers that mostly go up by one, as ticks do.
class Multiples {
 public:
  // `of` is above 0.
  explicit Multiples(int64_t of) : of_(of) {}

  int64_t of() const { return of_; }

  // Takes any number.
  bool Contains(int64_t number) { return UpTo(number) == number; }

  // The largest multiple that is not above `number`, which is not below 0.
  int64_t UpTo(int64_t number) {
    const uint64_t ahead = static_cast<uint64_t>(number) - static_cast<uint64_t>(newest_);
    if (number < newest_ || ahead >= static_cast<uint64_t>(of_)) {
      newest_ = ahead == static_cast<uint64_t>(of_) ? number : number / of_ * of_;
    }
    return newest_;
  }

 private:
  int64_t of_;
  int64_t newest_ = 0;
};

}  // namespace hydro
