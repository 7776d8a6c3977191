// Runs made by hand, for tests.
#pragma once

#include <array>
#include <limits>

#include "scope/signals/run.h"

namespace hydro::scope {

// An empty run of that rate.
inline Run MadeRun(double rate_hz = 1000) {
  Run run(0, "made", Run::Kind::kLive, std::numeric_limits<uint64_t>::max());
  run.rate_hz = rate_hz;
  run.session = 1;
  return run;
}

// Appends the tick with that p1; everything else is missing.
inline void AddTick(Run* run, int64_t tick, double p1) {
  std::array<double, kTickColumns> row;
  row.fill(std::numeric_limits<double>::quiet_NaN());
  row[static_cast<size_t>(TickColumn::kP1)] = p1;
  run->ticks.Append(static_cast<double>(tick) / run->rate_hz, row.data());
}

}  // namespace hydro::scope
