// Where the model and the data disagree: what each balance lacks along the measured runs.
#pragma once

#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/data/run_data.h"

namespace hydro::diagnose {

struct Localisation {
  std::vector<Location> location;    // by share, largest first; empty when nothing is missing
  std::vector<MissingTerm> missing;  // of the largest, against what it depends on most
  bool judged = false;  // some balance could be formed: an empty location says that nothing is missing
};

// `model` is the one that disagrees. Balances that the runs do not measure are left out: nothing is said about
// them. `jobs`: threads; the result does not depend on them. Throws ModelError as Equations does.
Localisation Locate(const model::ModelDescription& model, const std::vector<const RunData*>& runs,
                    int jobs = 1);

}  // namespace hydro::diagnose
