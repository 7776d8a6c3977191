// How much of a balance's disturbance noise does not explain, and on what it depends.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/diagnosis.h"
#include "diagnose/disturbance_smoother.h"
#include "diagnose/run_data.h"

namespace hydro {

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
  double energy = 0;        // sum of (value/noise)^2 less what noise alone makes of it
  double per_block = 0;     // that a block
  double significance = 0;  // that in its standard deviations
  Blocks blocks;            // the same, but enough of them to see what they depend on
};

Disagreement LargestDisagreement(const std::vector<SmoothedRun>& smoothed,
                                 const std::vector<const RunData*>& runs, Balance balance);

// What a disturbance may depend on: a value each sample of each run.
struct Variable {
  std::string name, unit;
  std::vector<std::vector<double>> values;
  bool linear_only = false;  // bins of it say nothing: it is near 0 most of the time
};

// A variable's means over the blocks.
std::vector<double> Average(const Variable& variable, const Blocks& blocks,
                            const std::vector<SmoothedRun>& smoothed, Balance balance);

// Share of the blocks' variance beyond noise that a function of the variable explains (a line, or steps of
// equal count), allowing for the number of its coefficients; 0 when chance does as well.
double Explained(const Blocks& blocks, const std::vector<double>& variable, bool linear_only);

// Means over bins of the variable, about 12 of equal count.
MissingTerm TableOf(const Blocks& blocks, const Variable& variable, const std::vector<double>& averages);

// The part of the variable's range that has most of the energy, as text: "|motor_speed| < 5.2 rad/s";
// when it is spread over all of it, how it changes there.
std::string RangeOf(const Blocks& blocks, const Variable& variable, const std::vector<double>& averages);

// The stretches of each run, up to five, with most energy; in order of time.
std::vector<Window> WindowsOf(const Blocks& blocks, const std::vector<const RunData*>& runs);

}  // namespace hydro
