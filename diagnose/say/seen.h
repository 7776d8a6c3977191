// What is seen of one balance: how much it lacks beyond noise, where and when, and what that depends on.
#pragma once

#include <string>
#include <vector>

#include "diagnose/recording/diagnosis.h"
#include "diagnose/say/binned_curve.h"
#include "diagnose/say/variables.h"

namespace hydro::diagnose {

// The lack of blocks over one variable.
struct Dependence {
  Variable variable;
  BinnedCurve curve;
  double explained = 0;
  double energy = 0;  // what shows over it beyond chance
};

// The blocks' points over the variable.
std::vector<CurvePoint> PointsOver(const Variable& variable, const std::vector<Block>& blocks,
                                   const std::vector<LackingRun>& runs, BalanceKind balance);

// By how much they explain; of those that explain nearly as much as the best, the simplest comes first. `variables`: simple ones
// first.
std::vector<Dependence> Ranked(const std::vector<Block>& blocks, std::vector<Variable> variables,
                               const std::vector<LackingRun>& runs, BalanceKind balance);

// The part of the variable's range that holds most of what is lacking, in words: "|motor_speed| < 5.2 rad/s". If it is spread over the
// whole range, how it changes there; "the same everywhere" where the variable explains nothing.
std::string WhereOf(const Dependence& dependence);

// The stretches of each run with the most of it, at most five, in order of time.
std::vector<Window> WindowsOf(const std::vector<Block>& blocks, const std::vector<LackingRun>& runs);

struct Seen {
  std::vector<Block> when;  // of the length at which most shows; empty where the balance cannot be formed
  std::vector<Block>
      where;  // of the length at which a variable explains most, of those that leave enough blocks to see that
  std::vector<Dependence> ranked;  // of `where`
  double energy = 0;               // 0: nothing beyond noise
};

Seen LookAt(const std::vector<LackingRun>& runs, BalanceKind balance, const UnitSystem& units);

}  // namespace hydro::diagnose
