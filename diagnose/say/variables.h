// What a balance's lack may depend on: the motion, the command, or late sensors.
#pragma once

#include <string>
#include <vector>

#include "diagnose/say/lacking.h"

namespace hydro::diagnose {

struct Variable {
  std::string name, unit;
  std::vector<std::vector<double>> values = {};  // by run, at every stride-th instant
  // It may say what a lack depends on, and is no evidence of one: a derivative has noise that is in the balance too, and over
  // time whatever happens at one time of one run is a dependence. What depends on it does so along a straight line.
  bool only_names = false;
  bool line = false;       // the same, of what is near 0 most of the time: bins are useless
  std::string where = "";  // the place in words; "": see RangeOf
};

// Of the motion, simple variables first; of pressures only where they were measured. `turns`: include those that repeat within a
// turn of the shaft.
std::vector<Variable> MotionVariables(const std::vector<LackingRun>& runs, BalanceKind balance,
                                      const UnitSystem& units, bool turns);
// The voltage, its excess over several limits, and its difference from itself after several lags.
std::vector<Variable> CommandVariables(const std::vector<LackingRun>& runs);
// What late readings add to a balance: the rates of the signals that drive it.
std::vector<Variable> LateVariables(const std::vector<LackingRun>& runs, BalanceKind balance,
                                    const UnitSystem& units);

}  // namespace hydro::diagnose
