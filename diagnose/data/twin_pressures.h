// Pressures of both sides that are the same: one column for both, or an open bypass that the sidecar does not state.
#pragma once

#include <string>

#include "runs/measured_run.h"

namespace hydro::diagnose {

// What is wrong, in one line with the sidecar's line that mends it; empty where the pressures differ, or may be the same.
std::string TwinPressures(const runs::MeasuredRun& run);

}  // namespace hydro::diagnose
