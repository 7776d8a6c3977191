// What the balances read of recordings together: of long ones a part, and of a sensor's noise what all runs
// of a recorder show.
#pragma once

#include <array>
#include <vector>

#include "diagnose/balances/run_motion.h"

namespace hydro::diagnose {

// For each run: one sensor has one noise in all runs of a recorder. A run in which it mostly rests shows
// less.
std::vector<std::array<double, kGridChannels>> LeastNoises(const std::vector<const RunData*>& runs);

// What of long recordings is read, so that the work of a diagnosis is bounded by counts: each run's every
// n-th sample, and, where fewer samples would be too coarse, the `part` of each run in which most happens.
struct RowsRead {
  size_t every = 1;
  double part = 1;
};
RowsRead RowsToRead(const std::vector<const RunData*>& runs);
// Where the stretch of `count` steps begins in which most happens, by what has happened up to each instant.
size_t StartOfBusiest(const std::vector<double>& happened, size_t count);
// The stretch of this part of the motion in which command and motor change most.
RunMotion BusiestPart(RunMotion motion, double part);

}  // namespace hydro::diagnose
