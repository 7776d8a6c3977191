// Reads a table of another recorder through the sidecar that describes it (docs/measured_runs.md).
#pragma once

#include <string>
#include <vector>

#include "base/unit_system.h"
#include "runs/measured_run.h"

namespace hydro::runs {

// The runs in a CSV or MAT file, in these units. Throws InputError as ReadMeasuredRun does.
std::vector<MeasuredRun> ReadTableRuns(const std::string& file, const UnitSystem& units);

}  // namespace hydro::runs
