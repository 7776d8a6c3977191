// What a balance lacks as a function of one variable that a closure may depend on: where the search for closures starts.
#pragma once

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

struct PossibleTerm {
  MissingTerm table;
  double low = 0, high = 0;  // what the runs reach of the variable, but for a thousandth at either end
  double explained = 0;      // share of the whole disagreement
};

}  // namespace hydro::diagnose
