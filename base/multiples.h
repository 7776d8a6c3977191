// Finds multiples of a fixed number without a division, for numbers that mostly go up by one, as ticks do.
#pragma once

#include <cstdint>

namespace hydro {

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
