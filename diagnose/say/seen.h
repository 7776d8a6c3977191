// What is seen of one balance: how much it lacks beyond noise, when, and what that depends on.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/say/variables.h"

namespace hydro::diagnose {

struct Dependence {
  Variable variable;
  std::vector<double> averages;
  double explained = 0;
  size_t simplicity = 0;  // place in the list: simple variables come first
};

// By how much they explain; of those that explain nearly as much as the best, the simplest comes first. `variables`: simple ones
// first.
std::vector<Dependence> Ranked(const Blocks& blocks, std::vector<Variable> variables,
                               const std::vector<LackingRun>& runs, BalanceKind balance);

struct Seen {
  Blocks when;  // of the length at which most shows
  Blocks
      where;  // of the length at which a variable explains most, of those that leave enough blocks to see that
  std::vector<Dependence> ranked;  // of `where`
  double energy = 0;               // 0: nothing beyond noise
};

Seen LookAt(const std::vector<LackingRun>& runs, BalanceKind balance, const UnitSystem& units);

}  // namespace hydro::diagnose
