// Finds columns of slow sensors that a recorder wrote at the rate of its table.
#pragma once

#include <string>
#include <vector>

#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

// If every value of a signal stands in several rows, equal to the bit, only the first of equal rows is a
// sample. The others become missing, and the signal gets its own time base and noise, like a signal with
// empty cells between its samples. A signal at rest, or one with an encoder's steps, repeats genuine values
// and is not changed. Returns a line for each signal of each run.
std::vector<std::string> SetAsideRepeats(std::vector<runs::MeasuredRun>* runs);

}  // namespace hydro::diagnose
