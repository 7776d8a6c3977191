// How much of a balance's disturbance noise does not explain.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/data/run_data.h"
#include "diagnose/locate/disturbance_smoother.h"

namespace hydro::diagnose {

// A disturbance averaged over blocks of equal length, for all runs that have the balance.
struct Blocks {
  double duration = 0;  // s, nominal
  struct Block {
    size_t run = 0, first = 0, end = 0;  // samples
    double value = 0, noise = 0;         // mean of the informative samples, its standard error by noise
  };
  std::vector<Block> blocks;
};

struct Disagreement {
  // At the block length, from one sample to a second, at which the disturbance shows most: shorter blocks
  // miss what is small and slow, longer ones what is quick.
  double energy = 0;          // sum of (value/noise)^2 less what noise alone contributes
  double significance = 0;    // the energy in its standard deviations
  bool beyond_noise = false;  // clearly, with a margin for errors of linearisation
  Blocks blocks;              // at the best length that leaves enough blocks to see dependences
};

Disagreement LargestDisagreement(const std::vector<SmoothedRun>& smoothed,
                                 const std::vector<const RunData*>& runs, Balance balance);

}  // namespace hydro::diagnose
