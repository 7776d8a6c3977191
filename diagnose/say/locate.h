// Where the model and the data disagree: what each balance lacks along the measured runs. If no balance shows
// a disagreement, the signal that is predicted worst.
#pragma once

#include <vector>

#include "diagnose/recording/diagnosis.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

struct Localisation {
  std::vector<Location> location;  // by share, largest first; empty where balances lack nothing beyond noise
  std::vector<MeasuredCurve> missing;  // of the largest, over the variable it depends on most
};

// `model` is the model that disagrees. Balances that the runs do not measure are left out, and nothing is
// said about them. `jobs` is the number of threads; the result does not depend on it. Throws ModelError as
// Equations does.
Localisation Locate(const model::ModelDescription& model, const std::vector<const RunData*>& runs,
                    int jobs = 1);

// For runs where no balance shows anything or none can be formed: the signal with the largest part of the
// squared gap, in noise units, under its own name, and the stretches where it is predicted worst. `after`
// selects the gap with what was found instead of that of the model as given. Empty where no signal exceeds
// its noise.
std::vector<Location> WorstSignal(const std::vector<SignalGap>& signals, const std::vector<RunCurves>& curves,
                                  bool after);

}  // namespace hydro::diagnose
