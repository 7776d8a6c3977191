// Clocks of a recording, as a simulation of it sees them.
#pragma once

#include <vector>

#include "diagnose/data/alignment.h"
#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

// Balances of measured signals (AlignClocks) see command, speed and pressures as the recorder filtered them;
// what drives a simulation should be what was there. Where clocks were found apart in every one of `runs`,
// the delays are corrected, all runs' alike, by whole samples so that the model predicts `runs` best with its
// friction, inertia, leakage and stiffness free; `held_out` gets the same corrections and has no say in them.
// `clocks` are corrected with them, their intervals widened by as much as they moved.
void CorrectClocks(const model::ModelDescription& model, const std::vector<size_t>& allowed_base, int jobs,
                   std::vector<RunData>* runs, std::vector<RunData>* held_out,
                   std::vector<ClockDelay>* clocks);

}  // namespace hydro::diagnose
