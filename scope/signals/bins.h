// Bins are what a plot shows of a signal: the smallest and largest sample in each column of pixels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scope/signals/history.h"

namespace hydro::scope {

// A column of a history. Where `hold` is above 0, a value lasts: a bin without a sample takes the last value
// before it that is at most `hold` s old.
struct Signal {
  const History* history = nullptr;
  size_t column = 0;
  double hold = 0;
};

// Bin k covers [Edge(k), Edge(k + 1)). Edges are multiples of the width, counted from the origin, so that
// grids with the same origin and width agree to the last bit on the bin of each sample.
struct BinGrid {
  double origin = 0;
  double width = 1;
  int64_t first = 0;  // first bin, counted from the origin
  uint32_t bins = 0;

  double Edge(uint32_t k) const { return origin + static_cast<double>(first + k) * width; }
  // The bin, counted from the origin, that holds `time`.
  int64_t BinOf(double time) const;
};

// The grid for a request for [t0, t1] on `pixels` columns. Bins are never narrower than the spacing of the
// samples. Where they would be, each bin is centred on a sample of `history` and holds that sample alone, if
// the samples are even. `spacing` is the distance of even samples in s; 0: unknown, and the grid is as
// requested. Bins beyond the newest sample are left out.
BinGrid GridFor(const History& history, double spacing, double t0, double t1, uint32_t pixels);

// Writes the extremes of the bins to `min` and `max`, which have room for all of them.
void FillBins(const Signal& signal, const BinGrid& grid, double* min, double* max);

enum BinFlags : uint32_t { kLastIncomplete = 1, kAnswerToGet = 2, kTriggerCapture = 4 };

// The binary message of the bins of several signals (docs/developers/scope_protocol.md).
std::string EncodeBins(uint32_t id, uint32_t run, uint32_t flags, const BinGrid& grid,
                       const std::vector<Signal>& signals);

}  // namespace hydro::scope
