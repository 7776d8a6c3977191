// What a balance's lack depends on, and where and when it is largest.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/say/variables.h"

namespace hydro::diagnose {

// A variable's means over the blocks.
std::vector<double> Average(const Variable& variable, const Blocks& blocks,
                            const std::vector<LackingRun>& runs, BalanceKind balance);

// Share of the blocks' variance beyond noise that a function of the variable explains (a line, or steps of
// equal count), allowing for the number of coefficients; 0 when chance does as well.
double Explained(const Blocks& blocks, const std::vector<double>& variable, bool linear_only);

// Means over about 12 bins of the variable with equal counts, their errors by the scatter of the blocks.
MissingTerm TableOf(const Blocks& blocks, const Variable& variable, const std::vector<double>& averages);

// The part of the variable's range that holds most of the energy, as text: "|motor_speed| < 5.2 rad/s". If
// the energy is spread over the whole range, how it changes there.
std::string RangeOf(const Blocks& blocks, const Variable& variable, const std::vector<double>& averages);

// The stretches of each run with the most energy, at most five, in order of time.
std::vector<Window> WindowsOf(const Blocks& blocks, const std::vector<LackingRun>& runs);

}  // namespace hydro::diagnose
