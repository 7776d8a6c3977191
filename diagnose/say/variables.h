// What a balance's lack may depend on: the motion, the command, or late sensors.
#pragma once

#include <string>
#include <vector>

#include "diagnose/say/lacking.h"

namespace hydro::diagnose {

struct Variable {
  std::string name, unit;
  std::vector<std::vector<double>> values;  // by run, at every stride-th instant
  bool linear_only = false;                 // binning it is useless: it is near 0 most of the time
  std::string where;                        // replaces the text of RangeOf; "": RangeOf's own text
  // It may say what a lack depends on, and is no evidence of one: a derivative has noise that is in the balance too, and over
  // time whatever happens at one time of one run is a dependence.
  bool only_names = false;
};

// Of the motion, simple variables first. `quick`: include those that repeat within a turn.
std::vector<Variable> MotionVariables(const std::vector<LackingRun>& runs, BalanceKind balance,
                                      const UnitSystem& units, bool quick);
// The voltage, its excess over several limits, and its difference from itself after several lags.
std::vector<Variable> CommandVariables(const std::vector<LackingRun>& runs);
// What late readings add to a balance: the rates of the signals that drive it.
std::vector<Variable> LateVariables(const std::vector<LackingRun>& runs, BalanceKind balance,
                                    const UnitSystem& units);

}  // namespace hydro::diagnose
