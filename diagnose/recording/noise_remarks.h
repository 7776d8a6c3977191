// What to say of runs whose stated noise is not what their samples show.
#pragma once

#include <string>
#include <vector>

#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// One remark for all runs of which the same signals are unlike what is stated, by more than a factor of two: what the samples show, how many
// times what is stated that is, and the lines of the sidecar that mend it. Noisier signals come first.
std::vector<std::string> NoiseRemarks(const std::vector<const RunData*>& runs);

}  // namespace hydro::diagnose
