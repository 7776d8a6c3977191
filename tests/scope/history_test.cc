#include "scope/signals/history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace hydro::scope {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Extremes BruteForce(const History& history, History::Row from, History::Row to, size_t column) {
  Extremes found;
  for (History::Row row = from; row < to; ++row) found.Add(history.value(row, column));
  return found;
}

bool Same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

History Filled(int rows, uint64_t most_rows = std::numeric_limits<uint64_t>::max()) {
  History history(2, most_rows);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < rows; ++i) {
    const double values[] = {i % 7 == 0 ? kNaN : normal(random), i < rows / 2 ? kNaN : normal(random)};
    EXPECT_TRUE(history.Append(i * 0.001, values));
  }
  return history;
}

// Tests that the extremes of any stretch are those of its samples, missing ones left out, whatever blocks it
// touches.
TEST(HistoryTest, ExtremesEqualThoseOfTheSamples) {
  const History history = Filled(20000);
  std::mt19937 random(2);
  std::uniform_int_distribution<History::Row> row(0, history.end());
  for (int i = 0; i < 3000; ++i) {
    History::Row from = row(random);
    History::Row to = i % 3 == 0 ? std::min(history.end(), from + row(random) % 50) : row(random);
    if (to < from) std::swap(from, to);
    for (size_t column = 0; column < 2; ++column) {
      const Extremes found = history.Find(from, to, column);
      const Extremes expected = BruteForce(history, from, to, column);
      ASSERT_TRUE(Same(found.min, expected.min) && Same(found.max, expected.max)) << from << " " << to;
    }
  }
}

// Tests that the same holds after old blocks were dropped, and that rows keep their numbers.
TEST(HistoryTest, DropsOldBlocks) {
  History history = Filled(20000);
  const double kept = history.value(15000, 0);
  history.DropBefore(10);
  EXPECT_EQ(history.begin() % 4096, 0u);
  EXPECT_GT(history.begin(), 4096u);
  EXPECT_LE(history.time(history.begin()), 10);
  EXPECT_EQ(history.end(), 20000u);
  EXPECT_TRUE(Same(history.value(15000, 0), kept));
  const Extremes found = history.Find(history.begin(), history.end(), 1);
  const Extremes expected = BruteForce(history, history.begin(), history.end(), 1);
  EXPECT_EQ(found.min, expected.min);
  EXPECT_EQ(found.max, expected.max);
}

// Tests that memory is bounded by the rows that are allowed, and a block more.
TEST(HistoryTest, IsBounded) {
  const History history = Filled(100000, 10000);
  EXPECT_GE(history.end() - history.begin(), 10000u);
  EXPECT_LE(history.end() - history.begin(), 10000u + 2 * 4096);
  EXPECT_LT(history.memory(), size_t{20000} * 3 * 8 * 2);
}

// Tests that rows are found by time, from anywhere before them.
TEST(HistoryTest, FindsRowsByTime) {
  const History history = Filled(10000);
  for (const double time : {-1.0, 0.0, 0.0005, 0.001, 4.0955, 4.096, 9.999, 10.0}) {
    History::Row expected = 0;
    while (expected < history.end() && history.time(expected) < time) ++expected;
    EXPECT_EQ(history.LowerBound(time), expected) << time;
    EXPECT_EQ(history.LowerBoundFrom(0, time), expected) << time;
    EXPECT_EQ(history.LowerBoundFrom(expected, time), expected) << time;
  }
}

// Tests that a row that is not newer is refused, and one without a time.
TEST(HistoryTest, TimesIncrease) {
  History history(1);
  const double value = 1;
  EXPECT_TRUE(history.Append(1, &value));
  EXPECT_FALSE(history.Append(1, &value));
  EXPECT_FALSE(history.Append(0.5, &value));
  EXPECT_FALSE(history.Append(kNaN, &value));
  EXPECT_FALSE(history.Append(std::numeric_limits<double>::infinity(), &value));
  EXPECT_EQ(history.end(), 1u);
}

}  // namespace
}  // namespace hydro::scope
