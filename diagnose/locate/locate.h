// Where the model and the data disagree: what each balance lacks along the measured runs.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/data/run_data.h"
#include "diagnose/locate/disturbance_smoother.h"

namespace hydro::diagnose {

// "pump_torque", and the unit of its terms.
std::string NameOf(Balance balance);
std::string UnitOf(Balance balance, const UnitSystem& units);

// What a balance lacks as a function of one variable that a closure may depend on.
struct PossibleTerm {
  MissingTerm table;
  double low = 0, high = 0;  // what the runs reach of the variable, but for a thousandth at either end
  double explained = 0;      // share of the whole disagreement
};

struct Localisation {
  std::vector<Location> location;      // by share, largest first; empty when nothing is missing
  std::vector<MissingTerm> missing;    // of the largest, against what it depends on most
  std::vector<PossibleTerm> possible;  // of all balances, what explains most first
};

// `model` is the one that disagrees. Balances that the runs do not measure are left out.
Localisation Locate(const model::ModelDescription& model, const std::vector<const RunData*>& runs);

}  // namespace hydro::diagnose
