#include "process/timing/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace hydro::timing {
namespace {

// Tests that percentiles of values over nine decades are within 1 % of the exact ones, and count, min and max
// exact.
TEST(HistogramTest, PercentilesWithinOnePercent) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(0, std::log(3.6e12));
  Histogram histogram;
  std::vector<int64_t> values;
  for (int i = 0; i < 100'000; ++i) {
    values.push_back(static_cast<int64_t>(std::exp(exponent(random))));
    histogram.Record(values.back());
  }
  std::sort(values.begin(), values.end());
  EXPECT_EQ(histogram.Count(), 100'000);
  EXPECT_EQ(histogram.Min(), values.front());
  EXPECT_EQ(histogram.Max(), values.back());
  for (const double percent : {0.01, 1.0, 10.0, 50.0, 90.0, 99.0, 99.9, 99.99, 100.0}) {
    const auto rank = static_cast<size_t>(std::ceil(percent / 100 * 100'000)) - 1;
    const auto exact = static_cast<double>(values[rank]);
    EXPECT_NEAR(static_cast<double>(histogram.Percentile(percent)), exact, 0.01 * exact) << percent;
  }
}

// Tests that every single value comes back within 1 %, and exactly below 256.
TEST(HistogramTest, SingleValues) {
  for (int64_t value = 0; value < Histogram::kHighest;
       value = value < 5000 ? value + 1 : value + value / 777) {
    Histogram histogram;
    histogram.Record(0);
    histogram.Record(value);
    histogram.Record(Histogram::kHighest);
    const int64_t found = histogram.Percentile(50);
    ASSERT_LE(std::abs(found - value), value / 100) << value;
    if (value < 256) {
      ASSERT_EQ(found, value);
    }
  }
}

// Tests that an empty histogram gives zeros, and that values outside the range are counted at its ends.
TEST(HistogramTest, EmptyAndOutOfRange) {
  Histogram histogram;
  EXPECT_EQ(histogram.Percentile(50), 0);
  EXPECT_EQ(histogram.Max(), 0);
  histogram.Record(-5);
  histogram.Record(INT64_MAX);
  EXPECT_EQ(histogram.Count(), 2);
  EXPECT_EQ(histogram.Min(), 0);
  EXPECT_EQ(histogram.Max(), Histogram::kHighest);
  EXPECT_EQ(histogram.Percentile(0), 0);
}

// Tests that merging equals recording in one, and that a reset forgets.
TEST(HistogramTest, MergeAndReset) {
  Histogram low, high, both;
  for (int64_t i = 1; i <= 1000; ++i) {
    low.Record(i);
    high.Record(1000 * i);
    both.Record(i);
    both.Record(1000 * i);
  }
  low.Merge(high);
  low.Merge(Histogram());
  EXPECT_EQ(low.Count(), both.Count());
  EXPECT_EQ(low.Min(), 1);
  EXPECT_EQ(low.Max(), 1'000'000);
  for (const double percent : {1.0, 25.0, 50.0, 75.0, 99.0})
    EXPECT_EQ(low.Percentile(percent), both.Percentile(percent));
  Histogram empty;
  empty.Merge(high);
  EXPECT_EQ(empty.Min(), 1000);
  low.Reset();
  EXPECT_EQ(low.Count(), 0);
  EXPECT_EQ(low.Max(), 0);
  EXPECT_EQ(low.Percentile(99), 0);
}

// Tests that ranges hold each value once, side by side in rising order, and are as narrow as promised: one
// value below 32, at most 1/16 above.
TEST(HistogramTest, Ranges) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(0, std::log(3.6e12));
  Histogram histogram;
  std::vector<int64_t> values;
  for (int i = 0; i < 20'000; ++i) {
    values.push_back(static_cast<int64_t>(std::exp(exponent(random))));
    histogram.Record(values.back());
  }
  std::sort(values.begin(), values.end());
  size_t next = 0;
  int ranges = 0;
  int64_t before = -1;
  histogram.ForEachRange([&](int64_t first, int64_t last, int64_t count) {
    ++ranges;
    ASSERT_GT(first, before);
    ASSERT_GE(last, first);
    ASSERT_LE(last - first, first < 32 ? 0 : first / 16);
    before = last;
    int64_t expected = 0;
    for (; next < values.size() && values[next] <= last; ++next) {
      ASSERT_GE(values[next], first);
      ++expected;
    }
    ASSERT_EQ(count, expected);
  });
  EXPECT_EQ(next, values.size());
  EXPECT_LE(ranges, 700);
  Histogram().ForEachRange([](int64_t, int64_t, int64_t) { FAIL() << "there is nothing"; });
}

}  // namespace
}  // namespace hydro::timing
