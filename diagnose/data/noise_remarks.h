// What to say of runs whose stated noise is not what their samples show.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/run_data.h"

namespace hydro::diagnose {

// Whether the samples of a signal show noise unlike what the run states, either way: by more than a factor of two.
bool IsUnlikeStated(const SignalData& signal);
// The same, and the samples show more.
bool IsNoisierThanStated(const SignalData& signal);

// One remark for all runs of which the same signals are unlike what is stated: what the samples show, how many
// times what is stated that is, and the lines of the sidecar that mend it. Noisier signals come first.
std::vector<std::string> NoiseRemarks(const std::vector<const RunData*>& runs);

}  // namespace hydro::diagnose
