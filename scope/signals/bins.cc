#include "scope/signals/bins.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace hydro::scope {
namespace {

constexpr uint32_t kBinsMessage = 1;
constexpr size_t kHeader = 6 * 4 + 2 * 8;  // bytes; the channels' count comes after the bins'
static_assert(std::endian::native == std::endian::little, "the messages are copied as they lie in memory");

template <class T>
void Put(std::string& bytes, size_t& at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
  at += sizeof value;
}

}  // namespace

int64_t BinGrid::BinOf(double time) const {
  constexpr double kMost = 4e15;  // beyond this, doubles cannot tell neighbouring bins apart
  auto k = static_cast<int64_t>(std::clamp(std::floor((time - origin) / width), -kMost, kMost));
  if (origin + static_cast<double>(k) * width > time) --k;
  if (origin + static_cast<double>(k + 1) * width <= time) ++k;
  return k;
}

BinGrid GridFor(const History& history, double spacing, double t0, double t1, uint32_t pixels) {
  BinGrid grid{t0, (t1 - t0) / pixels, 0, 0};
  if (history.empty() || !(t1 > t0) || t0 > history.last_time()) return grid;
  double most = pixels;
  if (spacing > 0 && grid.width < spacing) {
    // The grid begins half a sample before the first sample of the window. It uses that sample's own time
    // rather than a multiple of the spacing: the two differ by a rounding error, which half a sample
    // outweighs.
    const auto row = std::min(history.LowerBound(t0), history.end() - 1);
    grid.width = spacing;
    grid.origin = history.time(row) - spacing / 2;
    most = std::min(most, std::floor((t1 - grid.origin) / spacing) + 1);
  }
  const double kept = std::floor((history.last_time() - grid.origin) / grid.width) + 1;
  grid.bins = static_cast<uint32_t>(std::max(0.0, std::min(kept, most)));
  return grid;
}

void FillBins(const Signal& signal, const BinGrid& grid, double* min, double* max) {
  const History& history = *signal.history;
  History::Row row = history.LowerBound(grid.Edge(0));
  for (uint32_t k = 0; k < grid.bins; ++k) {
    const History::Row end = history.LowerBoundFrom(row, grid.Edge(k + 1));
    Extremes extremes = history.Find(row, end, signal.column);
    if (row == end && signal.hold > 0 && row > history.begin() &&
        grid.Edge(k) - history.time(row - 1) <= signal.hold) {
      extremes.Add(history.value(row - 1, signal.column));
    }
    min[k] = extremes.min;
    max[k] = extremes.max;
    row = end;
  }
}

std::string EncodeBins(uint32_t id, uint32_t run, uint32_t flags, const BinGrid& grid,
                       const std::vector<Signal>& signals) {
  std::string bytes(kHeader + signals.size() * 2 * grid.bins * sizeof(double), '\0');
  size_t at = 0;
  Put(bytes, at, kBinsMessage);
  Put(bytes, at, id);
  Put(bytes, at, run);
  Put(bytes, at, flags);
  Put(bytes, at, grid.Edge(0));
  Put(bytes, at, grid.width);
  Put(bytes, at, grid.bins);
  Put(bytes, at, static_cast<uint32_t>(signals.size()));
  std::vector<double> min(grid.bins);
  std::vector<double> max(grid.bins);
  for (const Signal& signal : signals) {
    FillBins(signal, grid, min.data(), max.data());
    for (const auto* values : {&min, &max}) {
      std::memcpy(bytes.data() + at, values->data(), grid.bins * sizeof(double));
      at += grid.bins * sizeof(double);
    }
  }
  return bytes;
}

}  // namespace hydro::scope
