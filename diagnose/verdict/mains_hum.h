// Mains hum in what a model leaves of a recording: a fault of the recorder that no effect explains.
#pragma once

#include <string>
#include <vector>

#include "diagnose/search/explanation.h"

namespace hydro::diagnose {

// One sentence for each signal of which the mains frequency, 50 or 60 Hz, is at least three tenths of the squared residual of the
// fitted runs, where that is above the noise. Empty where no run can be simulated.
std::vector<std::string> HumRemarks(const std::vector<const RunData*>& runs, const Fitted& fitted);

}  // namespace hydro::diagnose
