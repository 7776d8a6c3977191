// What a balance's disturbance depends on, and where and when it is largest.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/locate/disagreement.h"

namespace hydro::diagnose {

// A quantity that a disturbance may depend on: one value for each sample of each run.
struct Variable {
  std::string name, unit;
  std::vector<std::vector<double>> values;
  bool linear_only = false;  // binning it is useless: it is near 0 most of the time
  std::string where;         // replaces the text of RangeOf; "": RangeOf's own text
};

// A variable's means over the blocks.
std::vector<double> Average(const Variable& variable, const Blocks& blocks,
                            const std::vector<SmoothedRun>& smoothed, Balance balance);

// Share of the blocks' variance beyond noise that a function of the variable explains (a line, or steps of
// equal count), allowing for the number of coefficients; 0 when chance does as well.
double Explained(const Blocks& blocks, const std::vector<double>& variable, bool linear_only);

// Means over about 12 bins of the variable with equal counts.
MissingTerm TableOf(const Blocks& blocks, const Variable& variable, const std::vector<double>& averages);

// The part of the variable's range that holds most of the energy, as text: "|motor_speed| < 5.2 rad/s". If
// the energy is spread over the whole range, how it changes there.
std::string RangeOf(const Blocks& blocks, const Variable& variable, const std::vector<double>& averages);

// The stretches of each run with the most energy, at most five, in order of time.
std::vector<Window> WindowsOf(const Blocks& blocks, const std::vector<const RunData*>& runs);

}  // namespace hydro::diagnose
