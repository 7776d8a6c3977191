#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "base/integers.h"

namespace hydro {
namespace {

// Tests that it agrees with division for numbers that go up by one, stay, jump and go back, up to both ends
// of the range.
TEST(MultiplesTest, AgreesWithDivision) {
  constexpr int64_t kLowest = std::numeric_limits<int64_t>::min(),
                    kHighest = std::numeric_limits<int64_t>::max();
  std::vector<int64_t> numbers;
  for (int64_t i = 0; i < 60; ++i) numbers.push_back(i);
  numbers.insert(numbers.end(), {59,  59,  1000, 1001,     17,           0,       1,           -1,       -2,
                                 -25, -24, 3,    kHighest, kHighest - 1, kLowest, kLowest + 1, kHighest, 0,
                                 25,  50,  75,   76,       kLowest,      kHighest});
  for (const int64_t of : {int64_t{1}, int64_t{2}, int64_t{25}, int64_t{1} << 40, kHighest}) {
    Multiples multiples(of);
    for (const int64_t number : numbers) {
      EXPECT_EQ(multiples.Contains(number), number % of == 0) << number << " of " << of;
      if (number >= 0) {
        EXPECT_EQ(multiples.UpTo(number), number / of * of) << number << " of " << of;
      }
    }
  }
}

}  // namespace
}  // namespace hydro
