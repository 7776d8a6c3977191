// Finds the sidecar that describes a table.
#pragma once

#include <string>

#include "base/input_error.h"

namespace hydro::runs {

struct SidecarFile {
  std::string file;
  bool shared = false;  // it serves this table by its pattern
};

// run.toml for run.csv, if it exists; otherwise the sidecar in the same folder whose `tables` is a pattern
// that matches the table's name ("run*.csv"). Throws InputError where there is none, and where there are two.
SidecarFile FindSidecar(const std::string& table);

}  // namespace hydro::runs
