// Bins: what a plot shows of a signal, the smallest and largest sample of each column of pixels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scope/signals/history.h"

namespace hydro::scope {

// A column of a history. Where `hold` is above 0, a value lasts: a bin without a sample has the last one before it that is at
// most that old, s.
struct Signal {
  const History* history = nullptr;
  size_t column = 0;
  double hold = 0;
};

// Bin k covers [Edge(k), Edge(k + 1)). Edges are multiples of the width from the origin, so that grids of one origin and
// width agree on which bin a sample is in, to the last bit.
struct BinGrid {
  double origin = 0;
  double width = 1;
  int64_t first = 0;  // of its bins, counted from the origin
  uint32_t bins = 0;

  double Edge(uint32_t k) const { return origin + static_cast<double>(first + k) * width; }
  // The bin, counted from the origin, that holds `time`.
  int64_t BinOf(double time) const;
};

// The grid of a request for [t0, t1] on `pixels` columns. Bins are not narrower than the spacing of the samples: where they
// would be, each is centred on a sample of `history` and holds that one alone, if the samples are even. `spacing`: s, of its
// samples where they are even; 0: unknown, and the grid is as asked. Bins beyond the newest sample are left out.
BinGrid GridFor(const History& history, double spacing, double t0, double t1, uint32_t pixels);

// Writes the extremes of the bins to `min` and `max`, which have room for all.
void FillBins(const Signal& signal, const BinGrid& grid, double* min, double* max);

enum BinFlags : uint32_t { kLastIncomplete = 1, kAnswerToGet = 2, kTriggerCapture = 4 };

// The binary message of the bins of several signals (docs/developers/scope_protocol.md).
std::string EncodeBins(uint32_t id, uint32_t run, uint32_t flags, const BinGrid& grid,
                       const std::vector<Signal>& signals);

}  // namespace hydro::scope
