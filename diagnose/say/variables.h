// Variables on which a balance's lack may depend: the motion, the command, or late sensors.
#pragma once

#include <string>
#include <vector>

#include "diagnose/say/lacking.h"

namespace hydro::diagnose {

struct Variable {
  std::string name, unit;
  std::vector<std::vector<double>> values = {};  // by run, at every stride-th instant
  // The variable may name what a lack depends on, but is no evidence of a lack. A derivative has noise that
  // the balance has too, and over time anything that happens once in one run looks like a dependence. A lack
  // depends on such a variable along a straight line.
  bool only_names = false;
  bool line = false;       // the same, for a variable near 0 most of the time, where bins are useless
  std::string where = "";  // the place in words; "": see RangeOf
};

// Variables of the motion, simple ones first; of pressures only where they were measured. `turns` includes
// variables that repeat within a turn of the shaft.
std::vector<Variable> MotionVariables(const std::vector<LackingRun>& runs, BalanceKind balance,
                                      const UnitSystem& units, bool turns);
// Variables for one number of periods per turn, which need not be whole: the phase of such a wave, and a wave
// in proportion to the speed or the pressure difference.
void AddTurn(const std::vector<LackingRun>& runs, BalanceKind balance, const UnitSystem& units,
             double periods, std::vector<Variable>* all);
// The voltage, its excess over several limits, and its change over several lags.
std::vector<Variable> CommandVariables(const std::vector<LackingRun>& runs);
// What late readings add to a balance: the rates of the signals that drive it.
std::vector<Variable> LateVariables(const std::vector<LackingRun>& runs, BalanceKind balance,
                                    const UnitSystem& units);

}  // namespace hydro::diagnose
