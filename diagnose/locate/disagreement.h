// How much of a balance's disturbance noise does not explain.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/data/run_data.h"
#include "diagnose/locate/disturbance_smoother.h"

namespace hydro::diagnose {

// A disturbance averaged over blocks of one length, of all runs that have the balance.
struct Blocks {
  double duration = 0;  // s, nominal
  struct Block {
    size_t run = 0, first = 0, end = 0;  // samples
    double value = 0, noise = 0;         // mean of what is informative; its standard deviation by noise
  };
  std::vector<Block> blocks;
};

struct Disagreement {
  // At the length at which most shows, of one sample to a second: shorter blocks do not see what is small and
  // slow, longer ones what is quick.
  double energy = 0;          // sum of (value/noise)^2 less what noise alone makes of it
  double significance = 0;    // that in its standard deviations
  bool beyond_noise = false;  // plainly, with room for what linearising costs
  Blocks blocks;              // at the same length, but enough of them to see what they depend on
};

Disagreement LargestDisagreement(const std::vector<SmoothedRun>& smoothed,
                                 const std::vector<const RunData*>& runs, Balance balance);

}  // namespace hydro::diagnose
