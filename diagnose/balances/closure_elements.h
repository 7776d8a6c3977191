// The elements of the machine on which a curve may be missing: where it acts, and against which variable.
#pragma once

#include <string>
#include <vector>

#include "diagnose/balances/columns.h"

namespace hydro::diagnose {

struct ClosureElement {
  // One balance in which the curve acts, and the catalogue's effect that stands for it.
  struct Part {
    BalanceKind balance = BalanceKind::kTorque;
    double factor = 1;     // by which the curve counts there
    std::string effect;    // "closure.flow_1"
    std::string variable;  // in that balance: "p1"
  };
  std::string set;  // "closure.outer_flow(p)"
  int sines = 0;
  std::vector<Part> parts;
  double unit = 0;              // of the curve: the usual size of its balance
  double low = 0, high = 0;     // of the variable, a little beyond the range that was seen
  bool odd = false;             // the variable has a sign: places run from -1 to 1, else from 0 to 1
  double times_difference = 0;  // psi; above 0: the curve is multiplied by (p2 - p1) / times_difference

  // Where the variable's value lies on the curve.
  double PlaceOf(double value) const { return odd ? value / high : (value - low) / (high - low); }
};

// The elements that the runs can show. A curve over a variable with a sign is odd, because an even part is an
// offset or an asymmetry, and effects of the catalogue already name these.
std::vector<ClosureElement> ClosureElements(const ColumnSetup& setup, const std::vector<RunMotion>& runs);

}  // namespace hydro::diagnose
