// Remarks on runs whose stated noise differs from what their samples show.
#pragma once

#include <string>
#include <vector>

#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// What the samples' own noise leaves of a perfect prediction, in noise units: a root mean square over the
// runs' signals. 1, unless signals are noisier by more than a factor of two than is stated.
double NoiseShown(const std::vector<const RunData*>& runs);

// One remark for all runs in which the same signals differ from the stated noise by more than a factor of
// two. It says what the samples show, how many times the stated noise that is, and which lines correct the
// sidecar. Noisier signals come first.
std::vector<std::string> NoiseRemarks(const std::vector<const RunData*>& runs);

}  // namespace hydro::diagnose
