// Columns of slow sensors that a recorder wrote at the rate of its table.
#pragma once

#include <string>
#include <vector>

#include "runs/measured_run.h"

namespace hydro::diagnose {

// Of a signal whose every value stands in several rows, to the bit, only the first of equal rows is a sample: the others become missing, and
// the signal has a time base and a noise of its own, as one with empty cells between its samples. What rests, or has an encoder's steps,
// repeats honestly and stays. Returns a line for each signal of each run.
std::vector<std::string> SetAsideRepeats(std::vector<runs::MeasuredRun>* runs);

}  // namespace hydro::diagnose
