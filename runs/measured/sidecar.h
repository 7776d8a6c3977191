// Finds the sidecar that describes another recorder's table, and reads the table through it
// (docs/measured_runs.md).
#pragma once

#include <string>
#include <vector>

#include "base/input_error.h"
#include "base/unit_system.h"
#include "runs/measured/measured_run.h"

namespace hydro::runs {

// The runs in a CSV or MAT file, in these units. Throws InputError as ReadMeasuredRun does.
std::vector<MeasuredRun> ReadTableRuns(const std::string& file, const UnitSystem& units);

// Finds the sidecar that describes a table.
struct SidecarFile {
  std::string file;
  bool shared = false;  // it serves this table by its pattern
};

// run.toml for run.csv, if it exists; otherwise the sidecar in the same folder whose `tables` is a pattern
// that matches the table's name ("run*.csv"). Throws InputError where there is none, and where there are two.
SidecarFile FindSidecar(const std::string& table);

}  // namespace hydro::runs
