#include "diagnose/balances/test_functions.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

namespace hydro::diagnose {
namespace {

using std::numbers::pi;

// s: a shorter piece holds no test function that is smooth at both ends and slow enough to be trusted.
constexpr double kShortestPiece = 0.04;
// The overlap of neighbours, as a fraction of a tile.
constexpr double kOverlap = 0.45;
// Hz: the mains frequencies, and how far their hum reaches.
constexpr double kMains[] = {50, 60};
constexpr double kHum = 5;
// Hz, for tiles of a quarter of a second: narrow where machines differ, wide where noise dominates.
constexpr double kBandEnds[] = {1.5, 3.5, 8, 16, 30, 50, 80};
constexpr double kBandTile = 0.25;

struct Tile {
  double begin, end, rise, fall;  // samples
};

double Rise(double x) {
  x = std::clamp(x, -1.0, 1.0);
  x = std::sin(pi / 2 * std::sin(pi / 2 * x));
  return std::sin(pi / 4 * (1 + x));
}

void CutPiece(double begin, double end, double step, double length, std::vector<Tile>* tiles) {
  const double rise = std::min(std::max(3.0, std::floor(kRise / step)), std::floor((end - begin) / 6));
  const double a = begin + rise, b = end - rise;
  const int count = std::max(1, static_cast<int>(std::lround((b - a) * step / length)));
  const double width = (b - a) / count;
  for (int k = 0; k < count; ++k) {
    tiles->push_back({a + k * width, a + (k + 1) * width, k == 0 ? rise : kOverlap * width,
                      k == count - 1 ? rise : kOverlap * width});
  }
}

std::vector<Tile> Tiles(const std::vector<uint8_t>& mask, double step, double length) {
  std::vector<Tile> tiles;
  const double spread = std::max(1.0, std::ceil(kSpread / step));
  for (size_t i = 0; i < mask.size();) {
    if (mask[i] != 0) {
      ++i;
      continue;
    }
    size_t end = i;
    while (end < mask.size() && mask[end] == 0) ++end;
    const double from = static_cast<double>(i) + spread, to = static_cast<double>(end) - spread;
    if (to - from >= std::max(12.0, kShortestPiece / step)) CutPiece(from, to, step, length, &tiles);
    i = end;
  }
  return tiles;
}

bool IsHum(double frequency) {
  return std::any_of(std::begin(kMains), std::end(kMains),
                     [&](double mains) { return std::abs(frequency - mains) <= kHum; });
}

}  // namespace

double TileLength(double duration) { return std::clamp(duration / 20, 0.25, 1.0); }

int BandOf(double frequency, double length) {
  const double scale = kBandTile / length;
  int band = 0;
  for (const double end : kBandEnds) band += frequency > end * scale ? 1 : 0;
  return band;
}

std::vector<TestFunctions> TestFunctionsOf(const std::vector<uint8_t>& mask, double step, double length,
                                           double highest) {
  std::vector<TestFunctions> all;
  const auto samples = static_cast<Eigen::Index>(mask.size());
  for (const Tile& tile : Tiles(mask, step, length)) {
    const double width = tile.end - tile.begin;
    const int most =
        std::max(1, std::min(static_cast<int>(2 * width * step * highest), static_cast<int>(width / 2.2)));
    std::vector<double> frequencies;
    std::vector<bool> passed;
    for (int k = 0; k < most; ++k) {
      const double frequency = (k + 0.5) / (2 * width * step);
      passed.push_back(!IsHum(frequency));
      if (passed.back()) frequencies.push_back(frequency);
    }
    if (frequencies.empty()) continue;
    TestFunctions here;
    here.first = std::max<Eigen::Index>(0, static_cast<Eigen::Index>(std::ceil(tile.begin - tile.rise)));
    const Eigen::Index last =
        std::min(samples, static_cast<Eigen::Index>(std::floor(tile.end + tile.fall)) + 1);
    here.frequency =
        Eigen::Map<const Eigen::VectorXd>(frequencies.data(), static_cast<Eigen::Index>(frequencies.size()));
    here.values.resize(here.frequency.size(), last - here.first);
    for (Eigen::Index i = 0; i < here.values.cols(); ++i) {
      const double n = static_cast<double>(here.first + i);
      const double window =
          std::sqrt(2 / width) * Rise((n - tile.begin) / tile.rise) * Rise((tile.end - n) / tile.fall);
      // cos((k + 1/2) x) by recurrence: 2 cos(x) times the one before, less the one before that.
      const double x = pi * (n - tile.begin) / width, twice = 2 * std::cos(x);
      double now = std::cos(x / 2), before = now;
      Eigen::Index row = 0;
      for (int k = 0; k < most; ++k) {
        if (passed[static_cast<size_t>(k)]) here.values(row++, i) = window * now;
        before = std::exchange(now, twice * now - before);
      }
    }
    all.push_back(std::move(here));
  }
  return all;
}

}  // namespace hydro::diagnose
