// How numbers spread, and what they depend on.
#include "base/maths/spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/random.h"

namespace hydro::maths {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Tests quantiles at, between and beside infinite numbers.
TEST(SpreadTest, Quantiles) {
  const std::vector<double> sorted = {1, 2, 4, 8, kInfinity};
  EXPECT_EQ(Quantile(sorted, 0), 1);
  EXPECT_EQ(Quantile(sorted, 0.5), 4);
  EXPECT_EQ(Quantile(sorted, 0.625), 6);
  EXPECT_EQ(Quantile(sorted, 0.75), 8);
  EXPECT_EQ(Quantile(sorted, 0.9), kInfinity);
  EXPECT_EQ(Quantile(sorted, 1), kInfinity);
  EXPECT_EQ(Quantile({kInfinity, kInfinity}, 0.5), kInfinity);
  EXPECT_EQ(Quantile({3}, 0.7), 3);
}

// Tests Wilson's interval against published values, and that it stays within 0 and 1.
TEST(SpreadTest, Shares) {
  const Estimate half = Share(5, 10);
  EXPECT_EQ(half.value, 0.5);
  EXPECT_NEAR(half.low, 0.2366, 1e-4);
  EXPECT_NEAR(half.high, 0.7634, 1e-4);
  const Estimate none = Share(0, 10);
  EXPECT_EQ(none.value, 0);
  EXPECT_EQ(none.low, 0);
  EXPECT_NEAR(none.high, 0.2775, 1e-4);
  EXPECT_DOUBLE_EQ(Share(10, 10).high, 1);
}

// Tests correlations that are known: of straight lines, of 1 to 4 with two exchanged, of a constant list.
TEST(SpreadTest, Correlations) {
  EXPECT_DOUBLE_EQ(Correlation({1, 2, 3}, {10, 30, 50}), 1);
  EXPECT_DOUBLE_EQ(Correlation({1, 2, 3}, {5, 3, 1}), -1);
  EXPECT_DOUBLE_EQ(Correlation({1, 2, 3, 4}, {1, 3, 2, 4}), 0.8);
  EXPECT_EQ(Correlation({1, 2, 3}, {7, 7, 7}), 0);
}

// Tests rank correlations that are known: rising, falling and constant lists, a textbook's example (IQ and
// hours of television, -29/165), and ties, whose ranks are their mean: x 1, 2.5, 2.5, 4 and y 1, 3, 2, 4 give
// 4.5/sqrt(4.5 * 5).
TEST(SpreadTest, RankCorrelations) {
  EXPECT_DOUBLE_EQ(RankCorrelation({1, 2, 3, 4}, {0, 1, 100, kInfinity}), 1);
  EXPECT_DOUBLE_EQ(RankCorrelation({1, 2, 3, 4}, {4, 3, 2, -1}), -1);
  EXPECT_EQ(RankCorrelation({1, 2, 3, 4}, {5, 5, 5, 5}), 0);
  EXPECT_NEAR(
      RankCorrelation({106, 100, 86, 101, 99, 103, 97, 113, 112, 110}, {7, 27, 2, 50, 28, 29, 20, 12, 6, 17}),
      -29.0 / 165, 1e-12);
  EXPECT_NEAR(RankCorrelation({1, 2, 2, 4}, {1, 3, 2, 4}), 4.5 / std::sqrt(4.5 * 5), 1e-12);
}

// Tests main effects that are known: of three causes of 1, 2 and 0 standard deviations, and of one that acts
// both ways.
TEST(SpreadTest, MainEffects) {
  const int n = 20000;
  std::vector<double> first, second, none, sum, square;
  for (uint64_t i = 0; i < n; ++i) {
    first.push_back(StandardNormal(4 * i));
    second.push_back(StandardNormal(4 * i + 1));
    none.push_back(StandardNormal(4 * i + 2));
    sum.push_back(first.back() + 2 * second.back());
    square.push_back(first.back() * first.back());
  }
  // Bins leave out what happens within them: about a percent.
  EXPECT_NEAR(MainEffect(first, sum, 25), 0.2, 0.02);
  EXPECT_NEAR(MainEffect(second, sum, 25), 0.8, 0.02);
  EXPECT_NEAR(MainEffect(none, sum, 25), 0, 0.002);
  EXPECT_GT(MainEffect(first, square, 25), 0.85);
  EXPECT_NEAR(RankCorrelation(first, square), 0, 0.05);
  EXPECT_EQ(MainEffect(first, std::vector<double>(n, 3.0), 25), 0);
}

}  // namespace
}  // namespace hydro::maths
