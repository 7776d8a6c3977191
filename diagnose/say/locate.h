// Where the model and the data disagree: what each balance lacks along the measured runs; or, where no balance shows it, the signal
// that is predicted worst.
#pragma once

#include <vector>

#include "diagnose/recording/diagnosis.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

struct Localisation {
  std::vector<Location>
      location;  // by share, largest first; empty where no balance lacks anything beyond noise
  std::vector<MeasuredCurve> missing;  // of the largest, against what it depends on most
};

// `model` is the one that disagrees. Balances that the runs do not measure are left out: nothing is said about
// them. `jobs`: threads; the result does not depend on them. Throws ModelError as Equations does.
Localisation Locate(const model::ModelDescription& model, const std::vector<const RunData*>& runs,
                    int jobs = 1);

// Where no balance shows anything, or none can be formed: the signal with the largest part of the squared gap, in noise units,
// under its own name, and the stretches where it is predicted worst. `after`: with what was found, instead of the model as
// given. Empty where no signal is beyond its noise.
std::vector<Location> WorstSignal(const std::vector<SignalGap>& signals, const std::vector<RunCurves>& curves,
                                  bool after);

}  // namespace hydro::diagnose
