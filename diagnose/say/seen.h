// What one balance shows: how much it lacks beyond noise, where and when, and on what that depends.
#pragma once

#include <string>
#include <vector>

#include "diagnose/recording/diagnosis.h"
#include "diagnose/say/binned_curve.h"
#include "diagnose/say/variables.h"

namespace hydro::diagnose {

// The blocks' lack as a function of one variable.
struct Dependence {
  Variable variable;
  BinnedCurve curve;
  double explained = 0;
  double energy = 0;  // the part that depends on the variable, beyond chance
};

// The blocks as points over the variable.
std::vector<CurvePoint> PointsOver(const Variable& variable, const std::vector<Block>& blocks,
                                   const std::vector<LackingRun>& runs, BalanceKind balance);

// Sorts the variables by how much they explain. Of those that explain nearly as much as the best, the
// simplest comes first. `variables` has simple ones first.
std::vector<Dependence> Ranked(const std::vector<Block>& blocks, std::vector<Variable> variables,
                               const std::vector<LackingRun>& runs, BalanceKind balance);

// The part of the variable's range that holds most of what is lacking, in words: "|motor_speed| < 5.2 rad/s".
// If the lack is spread over the whole range, the text says how it changes there; "the same everywhere" if
// the variable explains nothing.
std::string WhereOf(const Dependence& dependence);

// The stretches of each run with the largest lack, at most five, in order of time.
std::vector<Window> WindowsOf(const std::vector<Block>& blocks, const std::vector<LackingRun>& runs);

struct Seen {
  std::vector<Block> when;  // blocks of the length that shows most; empty where the balance cannot be formed
  // Blocks of the length for which a variable explains most, among lengths with enough blocks to see that.
  std::vector<Block> where;
  std::vector<Dependence> ranked;  // of `where`
  double energy = 0;               // 0: nothing beyond noise
};

Seen LookAt(const std::vector<LackingRun>& runs, BalanceKind balance, const UnitSystem& units);

}  // namespace hydro::diagnose
