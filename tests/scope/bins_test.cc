#include "scope/signals/bins.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace hydro::scope {
namespace {

// 5 kHz, a ramp with one spike.
History Ramp(int rows, int spike) {
  History history(1);
  for (int i = 0; i < rows; ++i) {
    const double value = i == spike ? 1e6 : i;
    history.Append(i / 5000.0, &value);
  }
  return history;
}

struct FilledBins {
  std::vector<double> min;
  std::vector<double> max;
};
FilledBins Fill(const Signal& signal, const BinGrid& grid) {
  FilledBins filled{std::vector<double>(grid.bins), std::vector<double>(grid.bins)};
  FillBins(signal, grid, filled.min.data(), filled.max.data());
  return filled;
}

// Tests that a spike of one sample among 600,000 is in exactly one bin, at any zoom and place.
TEST(BinsTest, OneSampleIsNeverLost) {
  constexpr int kRows = 600000;
  for (const int spike : {0, 1, 4095, 4096, 123457, kRows - 1}) {
    const History history = Ramp(kRows, spike);
    for (const uint32_t pixels : {1u, 7u, 1200u, 4000u}) {
      const BinGrid grid = GridFor(history, 0, 0, 120, pixels);
      const FilledBins bins = Fill({&history, 0, 0}, grid);
      int with_spike = 0;
      for (uint32_t k = 0; k < grid.bins; ++k) with_spike += bins.max[k] == 1e6 ? 1 : 0;
      EXPECT_EQ(with_spike, 1) << spike << " on " << pixels;
    }
  }
}

// Tests that every sample is in one bin: no edge is counted twice or left out.
TEST(BinsTest, BinsShareNoSample) {
  const History history = Ramp(10000, -1);
  for (const double width : {0.01, 0.003, 1.0 / 3, 0.0007}) {
    BinGrid grid{0, width, 0, 0};
    grid.bins = static_cast<uint32_t>(grid.BinOf(history.last_time()) + 1);
    const FilledBins bins = Fill({&history, 0, 0}, grid);
    double next = 0;  // values are row numbers: the bins must go through all of them
    for (uint32_t k = 0; k < grid.bins; ++k) {
      if (std::isnan(bins.min[k])) continue;
      EXPECT_EQ(bins.min[k], next);
      next = bins.max[k] + 1;
    }
    EXPECT_EQ(next, 10000);
  }
}

// Tests that a bin's number and its edges agree for times on the edges, where a division rounds either way.
TEST(BinsTest, BinOfAgreesWithTheEdges) {
  BinGrid grid{0, 0.1, 0, 1};
  for (int i = 0; i < 100000; ++i) {
    const double time = i * 0.1;
    grid.first = grid.BinOf(time);
    ASSERT_LE(grid.Edge(0), time);
    ASSERT_LT(time, grid.Edge(1));
  }
}

// Tests that bins narrower than the samples' spacing become one for each sample, which has its exact value.
TEST(BinsTest, ZoomedInEachBinIsASample) {
  const History history = Ramp(10000, -1);
  const BinGrid grid = GridFor(history, 1 / 5000.0, 0.1, 0.12, 1200);
  EXPECT_EQ(grid.width, 1 / 5000.0);
  ASSERT_EQ(grid.bins, 101u);
  const FilledBins bins = Fill({&history, 0, 0}, grid);
  for (uint32_t k = 0; k < grid.bins; ++k) {
    EXPECT_EQ(bins.min[k], 500 + k);
    EXPECT_EQ(bins.max[k], 500 + k);
  }
}

// Tests that bins beyond the newest sample are left out, and that there are none where nothing is.
TEST(BinsTest, EndsWithTheHistory) {
  const History history = Ramp(5000, -1);  // to 0.9998 s
  EXPECT_EQ(GridFor(history, 0, 0, 2, 200).bins, 100u);
  EXPECT_EQ(GridFor(history, 0, 5, 6, 200).bins, 0u);
  EXPECT_EQ(GridFor(history, 0, 1, 1, 200).bins, 0u);
  EXPECT_EQ(GridFor(History(1), 0, 0, 1, 200).bins, 0u);
}

// Tests that a gap is one: bins without a sample are missing, also those whose samples are.
TEST(BinsTest, GapsAreMissing) {
  History history(1);
  for (int i = 0; i < 100; ++i) {
    const double value = i >= 20 && i < 30 ? std::numeric_limits<double>::quiet_NaN() : 1;
    if (i < 50 || i >= 60) history.Append(i * 0.01, &value);
  }
  const FilledBins bins = Fill({&history, 0, 0}, {-0.005, 0.01, 0, 100});
  for (int k = 0; k < 100; ++k) {
    const bool missing = (k >= 20 && k < 30) || (k >= 50 && k < 60);
    EXPECT_EQ(std::isnan(bins.min[k]), missing) << k;
    EXPECT_EQ(std::isnan(bins.max[k]), missing) << k;
  }
}

// Tests that a report lasts until the next, but not for ever.
TEST(BinsTest, HeldValuesLast) {
  History history(1);
  for (const double t : {1.0, 2.0}) history.Append(t, &t);
  const FilledBins bins = Fill({&history, 0, 2.5}, {0, 0.5, 0, 12});
  for (int k = 0; k < 12; ++k) {
    const double t = 0.5 * k;
    if (t < 1 || t > 4.5) {
      EXPECT_TRUE(std::isnan(bins.min[k])) << k;
    } else {
      EXPECT_EQ(bins.min[k], t < 2 ? 1 : 2) << k;
    }
  }
}

// Tests the layout of the binary message.
TEST(BinsTest, Encodes) {
  const History history = Ramp(10, -1);
  const std::string bytes =
      EncodeBins(7, 3, kLastIncomplete | kTriggerCapture, {0, 0.001, 1, 1}, {{&history, 0, 0}});
  ASSERT_EQ(bytes.size(), 40u + 16);
  uint32_t numbers[4];
  std::memcpy(numbers, bytes.data(), 16);
  EXPECT_EQ(numbers[0], 1u);
  EXPECT_EQ(numbers[1], 7u);
  EXPECT_EQ(numbers[2], 3u);
  EXPECT_EQ(numbers[3], 5u);
  double times[2];
  std::memcpy(times, bytes.data() + 16, 16);
  EXPECT_EQ(times[0], 0.001);
  EXPECT_EQ(times[1], 0.001);
  uint32_t counts[2];
  std::memcpy(counts, bytes.data() + 32, 8);
  EXPECT_EQ(counts[0], 1u);
  EXPECT_EQ(counts[1], 1u);
  double values[2];
  std::memcpy(values, bytes.data() + 40, 16);
  EXPECT_EQ(values[0], 5);  // samples 5 to 9 lie in [1, 2) ms
  EXPECT_EQ(values[1], 9);
}

}  // namespace
}  // namespace hydro::scope
